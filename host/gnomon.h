// The whole public interface: include this one file.
#pragma once

#include "gnomon/base/error.h"
#include "gnomon/base/progress.h"
#include "gnomon/scene/scene.h"
