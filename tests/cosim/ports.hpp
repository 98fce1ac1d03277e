#pragma once

#include <type_traits>

#include "blocks.hpp"
#include "machine.hpp"

namespace gravure::cosim {

/// Lists ports by name and width.
class PortLister {
 public:
  explicit PortLister(std::vector<Port>& ports) : ports_(ports) {}
  template <class Value>
  void operator()(const char* name, const Value&, int width = 1) {
    ports_.push_back({name, width});
  }

 private:
  std::vector<Port>& ports_;
};

/// Puts numbers on inputs, cut to their width.
class PortDriver {
 public:
  explicit PortDriver(std::span<const std::uint64_t> values) : next_(values.begin()) {}
  template <class Value>
  void operator()(const char*, Value& port, int width = 1) {
    const std::uint64_t value = *next_++ & Port{{}, width}.mask();
    if constexpr (std::is_same_v<Value, bool>) {
      port = value != 0;
    } else {
      port = static_cast<Value>(value);
    }
  }

 private:
  std::span<const std::uint64_t>::iterator next_;
};

class PortReader {
 public:
  explicit PortReader(std::span<std::uint64_t> values) : next_(values.begin()) {}
  template <class Value>
  void operator()(const char*, const Value& port, int = 1) {
    *next_++ = static_cast<std::uint64_t>(port);
  }

 private:
  std::span<std::uint64_t>::iterator next_;
};

/// A model class at the widths that `Ports` (blocks.hpp) stands for.
template <class Ports>
class ModelMachine final : public Machine {
 public:
  ModelMachine() {
    Ports::in(in_, PortLister(inputs_));
    typename Ports::Model::Outputs out;
    Ports::out(out, PortLister(outputs_));
  }
  const std::vector<Port>& inputs() const override { return inputs_; }
  const std::vector<Port>& outputs() const override { return outputs_; }
  void step(std::span<const std::uint64_t> in, std::span<std::uint64_t> out) override {
    Ports::in(in_, PortDriver(in));
    const typename Ports::Model::Outputs now = model_.step(in_);
    Ports::out(now, PortReader(out));
  }

 private:
  typename Ports::Model::Inputs in_;
  typename Ports::Model model_ = Ports::make();
  std::vector<Port> inputs_;
  std::vector<Port> outputs_;
};

}  // namespace gravure::cosim
