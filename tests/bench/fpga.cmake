add_executable(gravure_fpga_bench ${CMAKE_CURRENT_LIST_DIR}/fpga_bench.cpp)
target_link_libraries(gravure_fpga_bench PRIVATE gravure::emulator gravure::fpga_model gravure_build
  benchmark::benchmark_main)
