add_executable(gravure_twin_bench ${CMAKE_CURRENT_LIST_DIR}/twin_bench.cpp)
target_include_directories(gravure_twin_bench PRIVATE ${PROJECT_SOURCE_DIR}/engine/src/twin)
target_link_libraries(gravure_twin_bench PRIVATE gravure::twin gravure::sync gravure_build benchmark::benchmark)
