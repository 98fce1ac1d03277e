add_executable(motion_bench ${CMAKE_CURRENT_LIST_DIR}/motion_bench.cpp)
target_link_libraries(motion_bench PRIVATE gravure::motion gravure_build benchmark::benchmark benchmark::benchmark_main)
