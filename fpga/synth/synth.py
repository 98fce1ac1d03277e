#!/usr/bin/env python3
"""Synthesises, places and routes the board's logic and prints what it takes and how fast it is.

usage: synth.py [--seeds N] [--floor] [--rtl FOLDER] [DESIGN...]

designs.txt lists the designs. iCE40 HX8K: yosys and nextpnr-ice40, N seeds (default 5); figures are estimates of nextpnr
after routing, minimum / median / maximum over the seeds. ECP5: yosys alone, so no speed. With --floor only the designs
that have one are run, with the seed that designs.txt names, and a clock below its floor is a failure.
Exit status: 0 done, 1 below the floor or a tool failed, 77 a tool is missing (said on stdout)."""

import argparse
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
TARGET_MHZ = {"clk": 82, "clk_fast": 164}
MARGIN = 1.08  # what the placer is asked for, above the target
ICE40 = "synth_ice40 -abc9 -device hx -dffe_min_ce_use 200 -top {top} -json {json}"
ECP5 = "synth_ecp5 -abc9 -top {top} -json {json}"
CELLS = {"ice40": {"LUT4": ("SB_LUT4",), "carry": ("SB_CARRY",), "flip-flops": ("SB_DFF",), "block RAMs": ("SB_RAM",)},
         "ecp5": {"LUT4": ("LUT4",), "CCU2C": ("CCU2C",), "flip-flops": ("TRELLIS_FF",), "DP16KD": ("DP16KD",)}}


def read_designs():
    designs = []
    for line in (HERE / "designs.txt").read_text().splitlines():
        words = line.split("#")[0].split()
        if words:
            floors = dict(word[6:].split("=") for word in words[2:] if word.startswith("floor:"))
            seed = int(floors.pop("seed", 1))
            parameters = [word.split("=") for word in words[2:] if not word.startswith("floor:")]
            designs.append((words[0], words[1], parameters, seed, {clock: float(mhz) for clock, mhz in floors.items()}))
    return designs


def run(command, folder):
    made = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if made.returncode != 0:
        sys.exit(f"{command[0]} failed:\n" + "\n".join((made.stdout + made.stderr).splitlines()[-20:]))
    return made.stdout + made.stderr


def synthesise(recipe, module, parameters, rtl, folder, json_name):
    chparam = "".join(f"chparam -set {name} {value} {module}; " for name, value in parameters)
    files = " ".join(str(file) for file in sorted(rtl.glob("*.v")))
    run(["yosys", "-q", "-p", f"read_verilog -I{rtl} {files}; {chparam}"
         + recipe.format(top=module, json=json_name)], folder)


def count_cells(path, kinds):
    modules = json.loads(path.read_text())["modules"]
    top = next(m for m in modules.values() if int(m.get("attributes", {}).get("top", "0"), 2))
    types = [cell["type"] for cell in top["cells"].values()]
    return ", ".join(f"{sum(t.startswith(prefixes) for t in types)} {name}" for name, prefixes in kinds.items())


def place(folder, json_name, seed):
    """MHz of every clock, the slowest way from one clock to another in ns, and the share of logic cells."""
    clocks = "".join(f"ctx.addClock({name!r}, {mhz * MARGIN:.1f})\n" for name, mhz in TARGET_MHZ.items())
    (folder / "clocks.py").write_text(clocks)
    text = run(["nextpnr-ice40", "--hx8k", "--package", "ct256", "--json", json_name, "--seed", str(seed),
                "--pre-pack", "clocks.py", "--timing-allow-fail", "--pcf-allow-unconstrained"], folder)
    routed = text[text.rindex("Critical path report"):]
    mhz = {name: float(value) for name, value in re.findall(r"Max frequency for clock\s+'([a-z_]+)\$?[^']*':\s+([\d.]+) MHz", routed)}
    ways = re.findall(r"Max delay posedge (clk\w*)\S*\s+-> posedge (clk\w*)\S*\s*:\s+([\d.]+) ns", routed)
    crossing = max((float(ns) for source, sink, ns in ways if source != sink), default=0.0)
    cells = re.search(r"ICESTORM_LC:\s*(\d+)/\s*(\d+)", text)
    return mhz, crossing, f"{cells[1]} of {cells[2]} logic cells"


def show_speeds(name, results, floors):
    slow = 0
    for clock in sorted(results[0][0]):
        speeds = sorted(result[0][clock] for result in results)
        text = f"{speeds[0]:.0f} / {statistics.median(speeds):.0f} / {speeds[-1]:.0f} MHz"
        each = ", by seed: " + " ".join(f"{result[0][clock]:.1f}" for result in results) if len(results) > 1 else ""
        verdict = "closes" if statistics.median(speeds) >= TARGET_MHZ[clock] else "DOES NOT CLOSE"
        print(f"{name:14} iCE40 HX8K {clock:8} {text:26} {verdict} {TARGET_MHZ[clock]} MHz in the median of "
              f"{len(results)}{each}", flush=True)
        if clock in floors and speeds[0] < floors[clock]:
            print(f"{name}: {clock} {speeds[0]:.1f} MHz is below its floor of {floors[clock]:.0f} MHz")
            slow = 1
    crossing = max(result[1] for result in results)
    if crossing:
        print(f"{name:14} iCE40 HX8K between the clocks {crossing:.1f} ns at most, must be below "
              f"{1000 / TARGET_MHZ['clk_fast']:.1f} ns", flush=True)
        slow |= crossing >= 1000 / TARGET_MHZ["clk_fast"]
    return slow


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--floor", action="store_true")
    parser.add_argument("--rtl", type=pathlib.Path, default=HERE.parent / "rtl")
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    missing = [tool for tool in ("yosys", "nextpnr-ice40") if shutil.which(tool) is None]
    if missing:
        print("SKIPPED: not found: " + ", ".join(missing))
        return 77
    rtl = arguments.rtl.resolve()
    slow = 0
    for name, module, parameters, floor_seed, floors in read_designs():
        if (arguments.names and name not in arguments.names) or (arguments.floor and not floors):
            continue
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            synthesise(ICE40, module, parameters, rtl, folder, "ice40.json")
            seeds = [floor_seed] if arguments.floor else range(1, arguments.seeds + 1)
            results = [place(folder, "ice40.json", seed) for seed in seeds]
            print(f"{name:14} iCE40 HX8K {results[0][2]}: {count_cells(folder / 'ice40.json', CELLS['ice40'])}", flush=True)
            slow |= show_speeds(name, results, floors if arguments.floor else {})
            if not arguments.floor:
                synthesise(ECP5, module, parameters, rtl, folder, "ecp5.json")
                print(f"{name:14} ECP5       {count_cells(folder / 'ecp5.json', CELLS['ecp5'])}", flush=True)
    return slow


if __name__ == "__main__":
    sys.exit(main())
