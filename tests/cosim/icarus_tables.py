#!/usr/bin/env python3
"""Runs every timing table of fpga/timing on the Verilog under Icarus, the second simulator.

usage: icarus_tables.py [--rtl FOLDER] [TABLE...]

Makes a test bench from a table and the ports of its module. Exit status: 0 all hold, 1 one does not, 77 no Icarus."""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PORT = re.compile(r"^\s*(input|output)\s+(?:wire|reg)\s*(\[[^\]]*\])?\s*(\w+)\s*,?\s*$", re.M)
PARAMETER = re.compile(r"parameter\s+(?:\[[^\]]*\]\s*)?(\w+)\s*=\s*([^,\n)]+)")


def read_variants():
    variants = {}
    for line in (HERE / "variants.txt").read_text().splitlines():
        words = line.split("#")[0].split()
        if words:
            variants[words[0]] = (words[1], dict(word.split("=") for word in words[2:]))
    return variants


def read_table(path):
    block, rows = None, []
    for line in path.read_text().splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("block"):
            block = line.split()[1]
        elif line:
            clock, rest = line.split(":", 1)
            inputs, outputs = rest.split("->")
            rows.append((clock, [w.split("=") for w in inputs.split()], [w.split("=") for w in outputs.split()]))
    return block, rows


def bench(source, module, overrides, rows):
    parameters = {name: overrides.get(name, value.strip()) for name, value in PARAMETER.findall(source)}
    ports = PORT.findall(source)
    text = ["`timescale 1ns/1ns", "module bench;"]
    text += ['  `include "latencies.vh"']  # the clocks of rows may be sums of these
    text += [f"  localparam {name} = {value};" for name, value in parameters.items()]
    for direction, width, name in ports:
        kind = "reg" if direction == "input" else "wire"
        text.append(f"  {kind} {width} {name}" + (" = 0;" if kind == "reg" else ";"))
    given = ", ".join(f".{name}({name})" for name in parameters)
    text.append(f"  {module} " + (f"#({given}) " if given else "") + "dut ("
                + ", ".join(f".{name}({name})" for _, _, name in ports) + ");")
    if any(name == "clk_fast" for _, _, name in ports):  # every second edge, the first included, is one of clk too
        tick = "#1 begin clk_fast = 1; clk = seed_edge; end #1 begin clk_fast = 0; clk = 0; seed_edge = !seed_edge; end"
        text.append("  reg seed_edge = 1;")
    else:
        tick = "#1 clk = 1; #1 clk = 0;"
    text += ["  initial begin"]
    clock = rows[0][0]
    for row, inputs, outputs in rows:
        text.append(f"    if (({row}) < ({clock})) $display(\"WRONG clock {row}: clocks must rise\");")
        text.append(f"    repeat (({row}) - ({clock})) begin {tick} end")
        text += [f"    {name} = 64'd{int(value, 0)};" for name, value in inputs]
        text.append(f"    {tick}")
        clock = row + "+1"
        for name, value in outputs:
            text.append(f"    if ({name} !== {int(value, 0)}) $display(\"WRONG clock {row}: {name} = %0d, "
                        f"the table says {int(value, 0)}\", {name});")
    text += ['    $display("END");', "    $finish;", "  end", "endmodule"]
    return "\n".join(text) + "\n"


def run_table(path, rtl, variants):
    block, rows = read_table(path)
    module, overrides = variants[block]
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "bench.v"
        file.write_text(bench((rtl / f"{module}.v").read_text(), module, overrides, rows))
        program = str(pathlib.Path(folder) / "bench.vvp")
        made = subprocess.run(["iverilog", "-g2005", "-I", rtl, "-y", rtl, "-o", program, str(file)],
                              capture_output=True, text=True)
        if made.returncode != 0:
            return made.stderr
        shown = subprocess.run(["vvp", "-n", program], capture_output=True, text=True).stdout
    wrong = [line for line in shown.splitlines() if "WRONG" in line]
    return "\n".join(wrong) if wrong or "END" in shown else "the bench did not end:\n" + shown


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--rtl", type=pathlib.Path, default=ROOT / "fpga" / "rtl")
    parser.add_argument("tables", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()
    if shutil.which("iverilog") is None:
        print("SKIPPED: not found: iverilog (Debian: iverilog)")
        return 77
    failed = 0
    variants = read_variants()
    for path in arguments.tables or sorted((ROOT / "fpga" / "timing").glob("*.txt")):
        wrong = run_table(path, arguments.rtl.resolve(), variants)
        print(f"{path.stem:30} {'FAILED' if wrong else 'holds'}")
        if wrong:
            failed += 1
            print(wrong)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
