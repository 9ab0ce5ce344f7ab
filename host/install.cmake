# What `cmake --install` copies: library, public headers, program, and how CMake and pkg-config find them.
include(CMakePackageConfigHelpers)

# gnomon.h, what it includes, and the picture. Everything else in the rooms is the library's own business and may need
# headers that users do not have. tests/consumer compiles each of these alone.
set(public_headers
  base/error.h base/progress.h
  scene/scene.h scene/import.h scene/generators.h scene/gltf_export.h scene/ray_set.h scene/ray_record.h
  areas/vector.h areas/box.h areas/ray_tests.h areas/solids.h areas/convex_polygon.h areas/influence_area.h
  areas/ray_measure.h areas/projection.h areas/cone_weights.h areas/membership.h areas/areas_from_scene.h
  areas/area_rays.h areas/measure.h areas/shared_area.h areas/detect.h areas/detect_lights.h
  tree/build_options.h tree/bvh.h tree/box_frame.h tree/bvh_check.h tree/wide.h tree/regions.h tree/compact.h tree/build_reference.h tree/oracle.h tree/candidate_tree.h tree/top_level.h
  tree/optimise.h tree/depth_map.h tree/tree_file.h tree/tree_export.h
  tree/merge_leaves.h tree/trace_reference.h
  plan/ray_sample.h plan/child_order.h plan/optimise_for_rays.h plan/race.h plan/choose.h plan/outlook.h
  cl/opencl.h cl/check.h cl/handle.h cl/device.h cl/context.h cl/launch.h
  device/build_device.h device/collapse_device.h device/optimise_device.h device/compact_device.h device/trace_device.h
  device/forest.h device/join_wide.h device/find_areas.h device/trace_areas.h
  render/picture.h render/path_options.h render/path_tracer.h render/picture_tracing.h render/ray_recorder.h render/render.h render/heat_map.h render/png.h)
set(header_folder ${CMAKE_INSTALL_INCLUDEDIR}/gnomon)
install(FILES gnomon.h DESTINATION ${header_folder})
foreach(header ${public_headers})
  get_filename_component(room ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${header_folder}/${room})
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/kernels/shared/ DESTINATION ${header_folder}/shared FILES_MATCHING PATTERN "*.h")

install(TARGETS gnomon EXPORT gnomon
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET gnomon_program)
  install(TARGETS gnomon_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET gnomon_manual)
  install(DIRECTORY ${GNOMON_MANUAL}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
  install(FILES ${GNOMON_MANUAL}/completions/gnomon DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/gnomon)
install(EXPORT gnomon NAMESPACE gnomon:: FILE gnomonTargets.cmake DESTINATION ${package_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/gnomonConfig.cmake.in
  ${PROJECT_BINARY_DIR}/gnomonConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gnomonConfig.cmake ${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake
  DESTINATION ${package_folder})

# The .pc file finds its prefix from its own place, so that an installed tree may be moved.
set(pc_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pc /prefix/${pc_folder} /prefix)
configure_file(${PROJECT_SOURCE_DIR}/cmake/gnomon.pc.in ${PROJECT_BINARY_DIR}/gnomon.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/gnomon.pc DESTINATION ${pc_folder})
