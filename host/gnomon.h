// The whole public interface: include this one file. Scenes, trees and hits are values in namespace gnomon;
// devices and contexts live in gnomon::cl. Pictures are apart (gnomon/render/render.h).
#pragma once

#include "gnomon/base/error.h"
#include "gnomon/base/progress.h"
#include "gnomon/cl/context.h"
#include "gnomon/cl/device.h"
#include "gnomon/device/build_device.h"
#include "gnomon/device/trace_device.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/gltf_export.h"
#include "gnomon/scene/import.h"
#include "gnomon/scene/ray_set.h"
#include "gnomon/scene/scene.h"
#include "gnomon/tree/build_options.h"
#include "gnomon/tree/build_reference.h"
#include "gnomon/tree/bvh.h"
#include "gnomon/tree/bvh_check.h"
#include "gnomon/tree/oracle.h"
