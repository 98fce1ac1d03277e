add_executable(gravure_compile_bench ${CMAKE_CURRENT_LIST_DIR}/compile_bench.cpp)
target_link_libraries(gravure_compile_bench PRIVATE gravure::pipeline gravure::twin gravure::emulator gravure::sync
  gravure::grv gravure::image gravure::tiff TIFF::TIFF gravure_build benchmark::benchmark)
