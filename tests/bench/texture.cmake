add_executable(texture_bench ${CMAKE_CURRENT_LIST_DIR}/texture_bench.cpp)
target_link_libraries(texture_bench PRIVATE gravure::texture gravure::kinematics gravure_build benchmark::benchmark benchmark::benchmark_main)
