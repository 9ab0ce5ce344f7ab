# The ctest entries of the consumer. Sanitized libraries do not fit unsanitized users.
if(NOT GNOMON_SANITIZE AND GNOMON_INSTALL AND GNOMON_BUILD_PROGRAM)
  add_test(NAME consumer_test
           COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/consumer/check.sh ${PROJECT_BINARY_DIR} ${CMAKE_CXX_COMPILER})
  set_tests_properties(consumer_test PROPERTIES LABELS device TIMEOUT 600 COST 40
                       ENVIRONMENT "${GNOMON_TEST_CACHE_ENVIRONMENT}")
endif()
add_test(NAME subdirectory_test
         COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_SOURCE_DIR}/consumer/subdirectory
                 -B ${CMAKE_CURRENT_BINARY_DIR}/subdirectory --fresh -G Ninja
                 -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER})
set_tests_properties(subdirectory_test PROPERTIES LABELS unit TIMEOUT 60)
