#!/usr/bin/env python3
"""Makes the register map of host, board and documentation from registers.txt.

usage: generate.py            writes the three files
       generate.py --check    writes nothing; exit status 1 and the file's name where one is stale"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
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


def camel(name):
    return "k" + "".join(word.capitalize() for word in name.split("_"))


def make_header(registers):
    text = ["#pragma once", "", "// clang-format off", "// Made by fpga/regs/generate.py from registers.txt; change that file.", "",
            "#include <cstdint>", "#include <string_view>", "", "namespace gravure::fpga {", "",
            "enum class RegisterAccess : std::uint8_t { read_only, read_write, write_only };", "",
            "/// One register of the board; docs/registers.md explains them.", "struct Register {",
            "  std::string_view name;", "  std::uint64_t reset;", "  int bits;",
            "  std::uint8_t address;  ///< of its low 32-bit word", "  RegisterAccess access;", "};", ""]
    access = {"ro": "read_only", "rw": "read_write", "wo": "write_only"}
    for r in registers:
        text += [f"inline constexpr Register {camel(r['name'])}Register{{", f"    \"{r['name']}\", {r['reset']:#x}, "
                 f"{r['bits']}, {r['address']:#04x}, RegisterAccess::{access[r['access']]}}};"]
    text += ["", "inline constexpr Register kRegisters[] = {"]
    text += [f"    {camel(r['name'])}Register," for r in registers]
    return "\n".join(text + ["};", "", "}  // namespace gravure::fpga"]) + "\n"


def make_verilog(registers):
    text = ["// Made by fpga/regs/generate.py from registers.txt; change that file."]
    for r in registers:
        name = r["name"].upper()
        text += [f"localparam [7:0] ADDRESS_{name} = 8'h{r['address']:02x};",
                 f"localparam [{r['bits'] - 1}:0] RESET_{name} = {r['bits']}'h{r['reset']:x};"]
    return "\n".join(text) + "\n"


def make_page(registers):
    text = ["# Registers of the board", "",
            "Made by `fpga/regs/generate.py` from `fpga/regs/registers.txt`; change that file. Addresses count 32-bit words.",
            "Values of more than 32 bits take two words, low word first; writing the high word takes both. `ro` is read only,",
            "`rw` read and write, `wo` a command: reading gives 0.", "",
            "| address | name | bits | access | reset | range | meaning |", "|---|---|---|---|---|---|---|"]
    for r in registers:
        reset = f"{r['reset']:#x}" if r["reset"] > 0xFFFF else str(r["reset"])
        text.append(f"| 0x{r['address']:02x} | `{r['name']}` | {r['bits']} | {r['access']} | {reset} | {r['range']} | "
                    f"{r['meaning']} |".replace("|  |", "| |"))
    return "\n".join(text) + "\n"


def main():
    registers = read_registers()
    made = {ROOT / "fpga/model/include/gravure/fpga/register_map.hpp": make_header(registers),
            ROOT / "fpga/rtl/registers.vh": make_verilog(registers),
            ROOT / "docs/registers.md": make_page(registers)}
    stale = [path for path, text in made.items() if not path.exists() or path.read_text() != text]
    for path in stale:
        print(f"{path.relative_to(ROOT)}: {'stale; run fpga/regs/generate.py' if '--check' in sys.argv else 'written'}")
        if "--check" not in sys.argv:
            path.write_text(made[path])
    return 1 if stale and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
