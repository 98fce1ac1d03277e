add_executable(gravure_emulator_bench ${CMAKE_CURRENT_LIST_DIR}/emulator_bench.cpp)
target_link_libraries(gravure_emulator_bench PRIVATE gravure::emulator gravure::protocol gravure_build benchmark::benchmark)
