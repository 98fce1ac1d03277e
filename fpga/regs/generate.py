#!/usr/bin/env python3
"""Makes register map and latencies of host, board and documentation from registers.txt, blocks.txt and latencies.txt.

usage: generate.py            writes the files
       generate.py --check    writes nothing; exit status 1 and the file's name where one is stale"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
GOING_ON = """## Going on after a fault

1. Read `executed_lines` and `closed_slot`. They stand two seed clocks after `status` shows the fault, and until the next step.
2. Stop the slots, acknowledge.
3. Load the position of the line that many behind the one loaded before, and send lines from there on. Where bit 31 of
   `closed_slot` was set, clear the bits of that line's slots before bits 23..0: bit n of a frame is slot first slot + n.
4. Run, start. A line that is cut again before it came to new slots: the larger of both numbers counts.

No pulse is lost by that but the one that the closing gate cut short, and none fires twice, because of this rule: a slot has passed when
the gate let its decision through, in the window or not, bit 1 or 0, however soon the gate closed after that. A slot in whose midst the
gate closed has passed, since its pulse may have; one whose decision met the closed gate, on the same clock or later, has not: the gate
never opened for it. As the gate sees them, slots begin `SLOT_TO_GATE` seed clocks after their first clock, those of backward lines
`reverse_delay` later; with the delay shorter than a slot this never changes their order, so the slots of a line that have passed are
its first ones. A line is executed once its last slot has passed, and counts when that is over: with the next slot, or because the
gate closed in it. A line that began without a frame, while a fault stood or before the last acknowledge or load does not count.
A stop of the slots (control bit 0) cuts a line like a fault; an acknowledge while lines run drops what ran without a word."""

COLUMNS = ("name", "address", "bits", "access", "reset", "range", "meaning")


def read_registers():
    registers, taken = [], {}
    for number, line in enumerate((HERE / "registers.txt").read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) != len(COLUMNS):
            sys.exit(f"registers.txt:{number}: {len(cells)} columns, must be {len(COLUMNS)}")
        register = dict(zip(COLUMNS, cells))
        for key in ("address", "bits", "reset"):
            register[key] = int(register[key], 0)
        if register["access"] not in ("ro", "rw", "wo"):
            sys.exit(f"registers.txt:{number}: access \"{register['access']}\", must be ro, rw or wo")
        if register["reset"] >> register["bits"]:
            sys.exit(f"registers.txt:{number}: the reset value has more than {register['bits']} bits")
        for word in range((register["bits"] + 31) // 32):
            address = register["address"] + word
            if address in taken:
                sys.exit(f"registers.txt:{number}: address {address:#04x} is that of {taken[address]} already")
            taken[address] = register["name"]
        registers.append(register)
    return registers


def read_blocks():
    blocks = []
    for line in (HERE / "blocks.txt").read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            name, kind, version, size, meaning = [cell.strip() for cell in line.split("|")]
            blocks.append((name, int(kind) << 24 | int(version) << 16 | int(size), int(size), meaning))
    return blocks


def read_latencies():
    """(name, clocks as a number or a sum of names, clock, from and to)."""
    latencies = []
    for line in (HERE / "latencies.txt").read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            latencies.append([cell.strip() for cell in line.split("|")])
    return latencies


def clocks_of(latencies):
    """The number of clocks of every name."""
    values = {}
    for name, clocks, _, _ in latencies:
        values[name] = sum(values[term] if term in values else int(term) for term in clocks.split(" + "))
    return values


def not_zero(registers):
    """Those of one word whose range begins with 1 and whose writes the register file itself checks."""
    return [r for r in registers if r["range"].startswith("1..") and r["access"] == "rw" and r["bits"] <= 32
            and not r["name"].startswith("prescaler")]


def words_by_width(registers):
    """(bits, addresses as (register, word)) of the words that do not use all of their 32 bits."""
    widths = {}
    for r in registers:
        if r["access"] == "ro":
            continue
        for word in range((r["bits"] + 31) // 32):
            bits = min(32, r["bits"] - 32 * word)
            if bits < 32:
                widths.setdefault(bits, []).append((r, word))
    return sorted(widths.items())


def camel(name):
    return "k" + "".join(word.capitalize() for word in name.split("_"))


def make_header(registers, blocks):
    text = ["#pragma once", "", "// clang-format off", "// Made by fpga/regs/generate.py from registers.txt; change that file.", "",
            "#include <array>", "#include <cstdint>", "#include <string_view>", "", "namespace gravure::fpga {", "",
            "enum class RegisterAccess : std::uint8_t { read_only, read_write, write_only };", "",
            "/// One register of the board; docs/registers.md explains them.", "struct Register {",
            "  std::string_view name;", "  std::uint64_t reset;", "  int bits;",
            "  std::uint8_t address;  ///< of its low 32-bit word", "  RegisterAccess access;", "};", ""]
    access = {"ro": "read_only", "rw": "read_write", "wo": "write_only"}
    for r in registers:
        text += [f"inline constexpr Register {camel(r['name'])}Register{{", f"    \"{r['name']}\", {r['reset']:#x}, "
                 f"{r['bits']}, {r['address']:#04x}, RegisterAccess::{access[r['access']]}}};"]
    text += ["", "/// What a register of a board may say, where boards differ.", "struct RegisterRange {", "  std::int64_t low;",
             "  std::int64_t high;", "};"]
    for r in registers:
        if r["access"] == "ro" and r["range"]:
            text.append(f"inline constexpr RegisterRange {camel(r['name'])}Range{{{', '.join(r['range'].split('..'))}}};")
    text += ["", "/// The largest value that fits.", "constexpr std::uint64_t largest(const Register& one) noexcept {",
             "  return (std::uint64_t{1} << static_cast<unsigned>(one.bits)) - 1;", "}"]
    text += ["", "inline constexpr Register kRegisters[] = {"]
    text += [f"    {camel(r['name'])}Register," for r in registers]
    text += ["};", "", "/// Registers whose range begins with 1: the board refuses a 0.",
             f"inline constexpr std::array<std::uint8_t, {len(not_zero(registers))}> kNotZeroAddresses{{"]
    text += [f"    {camel(r['name'])}Register.address," for r in not_zero(registers)]
    text += ["};", "", "/// The bits of the word at `address` that no register has: the board refuses a write that sets one.",
             "constexpr std::uint32_t unused_bits(unsigned address) noexcept {", "  switch (address) {"]
    for bits, words in words_by_width(registers):
        text += [f"    case {camel(r['name'])}Register.address" + (f" + {word}" if word else "") + ":" for r, word in words]
        text += [f"      return {(1 << 32) - (1 << bits):#x};"]
    stored = [(r["address"] + word, r["reset"] >> 32 * word & 0xFFFFFFFF) for r in registers if r["access"] == "rw"
              for word in range((r["bits"] + 31) // 32)]
    text += ["    default:", "      return 0;", "  }", "}", "", "/// A word that is read back as it was written, and what it is before that.",
             "struct StoredWord {", "  std::uint8_t address;", "  std::uint32_t reset;", "};",
             f"inline constexpr std::array<StoredWord, {len(stored)}> kStoredWords{{{{"]
    text += [f"    {{{address:#04x}, {reset:#x}}}," for address, reset in stored] + ["}};"]
    text += ["", "/// The descriptor ROM from address 0x80 on: kind << 24 | version << 16 | size.",
             f"inline constexpr std::array<std::uint32_t, {len(blocks)}> kDescriptors{{"]
    text += [f"    {word:#010x},  // {name}: {size} {meaning}" for name, word, size, meaning in blocks]
    return "\n".join(text + ["};", "", "}  // namespace gravure::fpga"]) + "\n"


def words_of(register):
    """(address as Verilog writes it, reset value) of each of its words."""
    name = "ADDRESS_" + register["name"].upper()
    return [(name + (f" + 8'd{word}" if word else ""), register["reset"] >> 32 * word & 0xFFFFFFFF)
            for word in range((register["bits"] + 31) // 32)]


def make_verilog(registers):
    text = ["// Made by fpga/regs/generate.py from registers.txt; change that file."]
    for r in registers:
        name = r["name"].upper()
        text += [f"localparam [7:0] ADDRESS_{name} = 8'h{r['address']:02x};",
                 f"localparam [{r['bits'] - 1}:0] RESET_{name} = {r['bits']}'h{r['reset']:x};"]
    text += ["// The bits of a word that no register has. (No case: it would become a memory.)",
             "function [31:0] unused_bits(input [7:0] at);", "  unused_bits = 32'd0"]
    for bits, words in words_by_width(registers):
        names = [f"at == ADDRESS_{r['name'].upper()}" + (f" + 8'd{word}" if word else "") for r, word in words]
        text += ["      | {32{" + " ||\n             ".join(names) + f"}}}} & 32'h{(1 << 32) - (1 << bits):08x}"]
    text[-1] += ";"
    text += ["endfunction", "// Of these the register file refuses a 0.", "function refuses_zero(input [7:0] at);",
             "  refuses_zero = " + " ||\n      ".join("at == ADDRESS_" + r["name"].upper() for r in not_zero(registers)) + ";",
             "endfunction", "// These are read back as they were written.", "function reads_back(input [7:0] at);"]
    stored = [word for r in registers if r["access"] == "rw" for word in words_of(r)]
    text += ["  reads_back = " + " ||\n      ".join(f"at == {word}" for word, _ in stored) + ";", "endfunction",
             "// And like this before the first write.", "function [31:0] reset_word(input [7:0] at);"]
    text += ["  reset_word = 32'd0" + "".join(f"\n      | {{32{{at == {word}}}}} & 32'h{reset:x}" for word, reset in stored if reset) + ";",
             "endfunction"]
    return "\n".join(text) + "\n"


def make_rom(blocks):
    text = ["// Made by fpga/regs/generate.py from blocks.txt; change that file."]
    text += [f"6'd{number}: word <= 32'h{word:08x};  // {name}: {size} {meaning}"
             for number, (name, word, size, meaning) in enumerate(blocks)]
    return "\n".join(text) + "\n"


def make_latency_header(latencies):
    text = ["#pragma once", "", "// clang-format off", "// Made by fpga/regs/generate.py from latencies.txt; change that file.", "",
            "#include <array>", "#include <string_view>", "", "namespace gravure::fpga {", "",
            "// Clocks from the one before which an input stands to the one after which its effect shows, both included; of the",
            "// A-B generator from just after the one that takes it.", ""]
    for name, clocks, clock, path in latencies:
        terms = " + ".join(camel(term) if not term.isdigit() else term for term in clocks.split(" + "))
        text += [f"/// {clock} clocks: {path}.", f"inline constexpr int {camel(name)} = {terms};"]
    text += ["", "struct Latency {", "  std::string_view name;  ///< as latencies.txt and the timing tables write it", "  int clocks;", "};",
             f"inline constexpr std::array<Latency, {len(latencies)}> kLatencies{{{{"]
    text += [f"    {{\"{latency[0]}\", {camel(latency[0])}}}," for latency in latencies]
    return "\n".join(text + ["}};", "", "}  // namespace gravure::fpga"]) + "\n"


def make_latency_verilog(latencies):
    text = ["// Made by fpga/regs/generate.py from latencies.txt; change that file."]
    text += [f"localparam {name} = {clocks};  // {clock} clocks: {path}" for name, clocks, clock, path in latencies]
    return "\n".join(text) + "\n"


def make_page(registers, blocks, latencies):
    text = ["# Registers of the board", "",
            "Made by `fpga/regs/generate.py` from `registers.txt` and `blocks.txt` beside it. Addresses count 32-bit words.",
            "Values of more than 32 bits take two words, low word first; writing the high word takes both. `ro` is read only,",
            "`rw` read and write (what is read is what was accepted there last, a low word even before its high one), `wo` a command:\nreading gives 0. The board refuses (status bit 11) a 0 where a range begins with 1, a",
            "value of more bits than the register has, any change from 0x30 to 0x35 and from 0x39 to 0x3f (but low_level) while slots run, and to run slots while their settings",
            "do not fit together or are younger than four clocks. A-B registers are checked when they are loaded.", "",
            "| address | name | bits | access | reset | range | meaning |", "|---|---|---|---|---|---|---|"]
    for r in registers:
        reset = f"{r['reset']:#x}" if r["reset"] > 0xFFFF else str(r["reset"])
        text.append(f"| 0x{r['address']:02x} | `{r['name']}` | {r['bits']} | {r['access']} | {reset} | {r['range']} | "
                    f"{r['meaning']} |".replace("|  |", "| |"))
    text += ["", GOING_ON]
    text += ["", "## Descriptor ROM", "", "What the board is made of, a word a block (kind in bits 31..24, version in 23..16, size in 15..0) and a 0 behind the",
             "last. The host reads it when it opens the board.", "", "| address | word | block | size |", "|---|---|---|---|"]
    text += [f"| {0x80 + number:#04x} | {word:#010x} | {name} | {size} {meaning} |"
             for number, (name, word, size, meaning) in enumerate(blocks)]
    text += ["", "## Latencies", "", "From `latencies.txt`; model and Verilog take them from there and are measured against them by the",
             "[timing tables](timing.md). A value that stands before clock c shows just after clock c + latency - 1. Those of the A-B generator",
             "(the last four) count from just after the clock that takes the input.", "", "| name | clocks | clock | from, to |",
             "|---|---|---|---|"]
    values = clocks_of(latencies)
    text += [f"| `{name}` | {values[name]} | {clock} | {path} |" for name, _, clock, path in latencies]
    return "\n".join(text) + "\n"


def main():
    registers, blocks, latencies = read_registers(), read_blocks(), read_latencies()
    made = {ROOT / "fpga/model/include/gravure/fpga/register_map.hpp": make_header(registers, blocks),
            ROOT / "fpga/rtl/registers.vh": make_verilog(registers),
            ROOT / "fpga/rtl/descriptors.vh": make_rom(blocks),
            ROOT / "fpga/model/include/gravure/fpga/latencies.hpp": make_latency_header(latencies),
            ROOT / "fpga/rtl/latencies.vh": make_latency_verilog(latencies),
            ROOT / "docs/registers.md": make_page(registers, blocks, latencies)}
    stale = [path for path, text in made.items() if not path.exists() or path.read_text() != text]
    for path in stale:
        print(f"{path.relative_to(ROOT)}: {'stale; run fpga/regs/generate.py' if '--check' in sys.argv else 'written'}")
        if "--check" not in sys.argv:
            path.write_text(made[path])
    return 1 if stale and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
