#include "timing_table.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "gravure/fpga/latencies.hpp"

namespace gravure::cosim {
namespace {

std::map<std::string, std::uint64_t> read_settings(std::istream& words, const std::string& stop,
                                                   const std::string& where) {
  std::map<std::string, std::uint64_t> settings;
  for (std::string word; words >> word && word != stop;) {
    const auto equal = word.find('=');
    if (equal == std::string::npos) {
      throw std::runtime_error(std::string(where).append(": \"").append(word).append("\" is not name=value"));
    }
    settings[word.substr(0, equal)] = std::stoull(word.substr(equal + 1), nullptr, 0);
  }
  return settings;
}

std::uint64_t number_or_latency(const std::string& word, const std::string& where) {
  if (word.find_first_not_of("0123456789") == std::string::npos && !word.empty()) {
    return std::stoull(word);
  }
  const auto* const found = std::find_if(fpga::kLatencies.begin(), fpga::kLatencies.end(),
                                         [&word](const fpga::Latency& latency) { return latency.name == word; });
  if (found == fpga::kLatencies.end()) {
    throw std::runtime_error(std::string(where).append(": \"").append(word).append("\" is no latency"));
  }
  return static_cast<std::uint64_t>(found->clocks);
}

/// "88+2*SLOT_TO_GATE": a sum of products.
std::uint64_t read_clock(const std::string& text, const std::string& where) {
  std::uint64_t sum = 0;
  std::istringstream terms(text);
  for (std::string term; std::getline(terms, term, '+');) {
    std::uint64_t product = 1;
    std::istringstream factors(term);
    for (std::string factor; std::getline(factors, factor, '*');) {
      product *= number_or_latency(factor, where);
    }
    sum += product;
  }
  return sum;
}

std::size_t index_of(const std::vector<Port>& ports, const std::string& name) {
  const auto found = std::find_if(ports.begin(), ports.end(), [&name](const Port& port) { return port.name == name; });
  if (found == ports.end()) {
    throw std::runtime_error("no port \"" + name + "\"");
  }
  return static_cast<std::size_t>(found - ports.begin());
}

}  // namespace

TimingTable read_timing_table(const std::string& path) {
  std::ifstream file(path);
  TimingTable table;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::string where = path + ":" + std::to_string(number);
    line = line.substr(0, line.find('#'));
    std::istringstream words(line);
    std::string first;
    if (!(words >> first)) {
      continue;
    }
    if (first == "block") {
      words >> table.block;
      continue;
    }
    if (first.back() != ':') {
      throw std::runtime_error(where + ": a row starts with \"clock:\"");
    }
    TimingTable::Row row;
    row.clock = read_clock(first.substr(0, first.size() - 1), where);
    row.inputs = read_settings(words, "->", where);
    row.outputs = read_settings(words, "", where);
    if (!table.rows.empty() && row.clock <= table.rows.back().clock) {
      throw std::runtime_error(where + ": clocks must rise");
    }
    table.rows.push_back(std::move(row));
  }
  if (table.block.empty() || table.rows.empty()) {
    throw std::runtime_error(path + ": no block or no rows");
  }
  return table;
}

std::vector<std::string> timing_table_paths() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(GRAVURE_TIMING_FOLDER)) {
    if (entry.path().extension() == ".txt") {
      paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string run_timing_table(const TimingTable& table, Machine& machine) {
  std::vector<std::uint64_t> in(machine.inputs().size());
  std::vector<std::uint64_t> out(machine.outputs().size());
  std::uint64_t clock = table.rows.front().clock;
  for (const TimingTable::Row& row : table.rows) {
    for (; clock < row.clock; ++clock) {
      machine.step(in, out);
    }
    for (const auto& [name, value] : row.inputs) {
      in[index_of(machine.inputs(), name)] = value;
    }
    machine.step(in, out);
    ++clock;
    for (const auto& [name, value] : row.outputs) {
      const std::uint64_t seen = out[index_of(machine.outputs(), name)];
      if (seen != value) {
        return "clock " + std::to_string(row.clock) + ": " + name + " = " + std::to_string(seen) + ", the table says " +
               std::to_string(value);
      }
    }
  }
  return {};
}

}  // namespace gravure::cosim
