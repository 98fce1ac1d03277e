#include "timing_table.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

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
    row.clock = std::stoull(first);
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
