add_executable(gravure_session_bench ${CMAKE_CURRENT_LIST_DIR}/session_bench.cpp)
target_include_directories(gravure_session_bench PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
target_link_libraries(gravure_session_bench PRIVATE gravure::session gravure::emulator gravure::sync gravure::grv gravure_build benchmark::benchmark)
