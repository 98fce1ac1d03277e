#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "bench_case.hpp"

/// What the parts of gravure_table_step share (table_step.cpp says what it does).
namespace gravure::bench {

using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kWidth = 3500;
constexpr std::uint32_t kHeight = 27489;

[[noreturn]] inline void stop(const std::string& why) {
  std::cerr << why << "\n";
  std::exit(1);
}

// table_pictures.cpp

inline std::uint32_t noise(std::uint32_t x, std::uint32_t y) {
  std::uint32_t v = x * 0x9E3779B1U ^ y * 0x85EBCA77U;
  v ^= v >> 15U;
  v *= 0x2C1B3C6DU;
  return v ^ v >> 12U;
}

/// Names are KIND_FORM.tif; the rest of this program and tests/bench/table know a file by its name, to which `.columns`
/// (lines along columns) or `.stack` (ten layers of it) may be added.
void write_pictures(const std::filesystem::path& folder);
Picture picture_of(const std::string& file);
/// The walls of the cells again and again across and around a roller of 300 mm, one metre wide, at 5 um.
void write_roller(const std::string& path);

// table_steps.cpp

using Pieces = std::function<void(std::span<const std::byte>)>;
/// What a bare loop over libtiff costs: the floor for every reader that goes through it.
void decode(const std::string& path, const Pieces& take);
std::function<void()> step_named(const std::string& step, const Picture& picture, const std::string& work);

// table_measure.cpp

double cpu_ms();
/// Of this program alone: what getrusage() gives begins with the peak of the process that started it.
double peak_mib();
/// Repeats a step after a warm-up; prints CPU ms of one, peak MiB, wall ms of one.
void repeat(const std::function<void()>& step, double seconds);

// table_slices.cpp

/// Slices of a map that is in memory, placed and dropped; before that the lines of all of them go to `out` once.
void slice_held(const Picture& picture, const std::string& out);

// table_growth.cpp

/// A generated picture through the compiler, packed and dropped; prints CPU ms and peak MiB.
void grow(double gigapixels, bool dense, bool columns);

}  // namespace gravure::bench
