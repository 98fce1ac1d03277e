add_executable(registration_bench ${CMAKE_CURRENT_LIST_DIR}/registration_bench.cpp)
target_include_directories(registration_bench PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
target_link_libraries(registration_bench PRIVATE gravure::registration gravure_build benchmark::benchmark benchmark::benchmark_main lz4)
