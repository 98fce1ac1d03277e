add_executable(gravure_sync_bench ${CMAKE_CURRENT_LIST_DIR}/sync_bench.cpp)
target_link_libraries(gravure_sync_bench PRIVATE gravure::sync gravure::plan_json gravure_build
  benchmark::benchmark_main)
