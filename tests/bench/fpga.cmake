add_executable(gravure_fpga_bench ${CMAKE_CURRENT_LIST_DIR}/fpga_bench.cpp)
target_link_libraries(gravure_fpga_bench PRIVATE gravure::emulator gravure::fpga_model gravure_build
  benchmark::benchmark_main)

# Event models against clocks, in one run; with the Verilog too where verilator is there.
add_executable(gravure_fpga_ratio_bench ${CMAKE_CURRENT_LIST_DIR}/fpga_ratio_bench.cpp)
target_link_libraries(gravure_fpga_ratio_bench PRIVATE gravure::emulator gravure::fpga_model gravure_build)
find_program(GRAVURE_VERILATOR verilator)
if(GRAVURE_VERILATOR)
  execute_process(COMMAND ${GRAVURE_VERILATOR} --getenv VERILATOR_ROOT
    OUTPUT_VARIABLE verilator_root OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(verilated ${CMAKE_CURRENT_BINARY_DIR}/rtl_counter)
  set(rtl ${PROJECT_SOURCE_DIR}/fpga/rtl)
  file(GLOB files CONFIGURE_DEPENDS ${rtl}/*.v ${rtl}/*.vh)
  add_custom_command(OUTPUT ${verilated}/all.cpp
    COMMAND ${GRAVURE_VERILATOR} --cc -O3 --x-assign fast --x-initial fast --noassert -Wall --top-module ab_generator
            --prefix Vab_generator -Mdir ${verilated} -I${rtl} ${rtl}/ab_generator.v
    COMMAND ${CMAKE_COMMAND} -D FOLDER=${verilated} -P ${PROJECT_SOURCE_DIR}/tests/cosim/join_sources.cmake
    DEPENDS ${files} COMMENT "Verilating ab_generator for the benchmark" VERBATIM)
  # A program of its own sources alone gets -flto: the one flag that makes Verilator's code fast.
  add_library(gravure_rtl_counter STATIC EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/fpga_rtl_counter.cpp
    ${verilated}/all.cpp ${verilator_root}/include/verilated.cpp ${verilator_root}/include/verilated_threads.cpp)
  target_include_directories(gravure_rtl_counter PRIVATE ${verilated})
  target_include_directories(gravure_rtl_counter SYSTEM PRIVATE ${verilator_root}/include ${verilator_root}/include/vltstd)
  target_compile_options(gravure_rtl_counter PRIVATE -w -O3 -flto)
  target_link_libraries(gravure_rtl_counter PUBLIC gravure::fpga_model Threads::Threads)
  target_link_libraries(gravure_fpga_ratio_bench PRIVATE gravure_rtl_counter)
  target_link_options(gravure_fpga_ratio_bench PRIVATE -O3 -flto)
  target_compile_definitions(gravure_fpga_ratio_bench PRIVATE GRAVURE_WITH_VERILATOR)
endif()
