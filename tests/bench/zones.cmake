add_executable(zones_bench ${CMAKE_CURRENT_LIST_DIR}/zones_bench.cpp)
target_include_directories(zones_bench PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
target_link_libraries(zones_bench PRIVATE gravure::zones gravure_build benchmark::benchmark benchmark::benchmark_main lz4)
