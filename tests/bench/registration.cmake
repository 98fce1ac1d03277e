add_executable(registration_bench ${CMAKE_CURRENT_LIST_DIR}/registration_bench.cpp)
target_include_directories(registration_bench PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
target_link_libraries(registration_bench PRIVATE gravure::registration gravure_build benchmark::benchmark benchmark::benchmark_main lz4)
set(registration_programs registration_bench)
# libpcl-dev brings 238 packages, so tests/packages.txt does not ask for it.
find_package(PkgConfig REQUIRED)
pkg_check_modules(PCL QUIET IMPORTED_TARGET pcl_registration)
if(PCL_FOUND)
  add_executable(gravure_peer_pcl ${CMAKE_CURRENT_LIST_DIR}/peers/pcl.cpp)
  target_include_directories(gravure_peer_pcl PRIVATE ${PROJECT_SOURCE_DIR}/tests/support ${CMAKE_CURRENT_LIST_DIR})
  target_link_libraries(gravure_peer_pcl PRIVATE gravure::registration PkgConfig::PCL gravure_build benchmark::benchmark
    benchmark::benchmark_main lz4)
  list(APPEND registration_programs gravure_peer_pcl)
endif()
