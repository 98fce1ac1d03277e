#!/usr/bin/env python3
"""Changes the Verilog in many small ways and checks that each is caught by a timing table or a proof.

usage: mutate.py [NUMBER...]     (all of mutations.txt, or these, counted from 1)

Exit status: 0 all caught, 1 one was not, 77 a tool is missing."""

import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BAR = "\0"


def read_mutations():
    mutations = []
    for line in (HERE / "mutations.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            cells = [cell.strip().replace(BAR, "|").replace("\\n", "\n") for cell in line.replace("\\|", BAR).split("|")]
            mutations.append(cells)
    return mutations


def caught_by(rtl, module):
    tables = subprocess.run([sys.executable, ROOT / "tests/cosim/icarus_tables.py", "--rtl", rtl], capture_output=True,
                            text=True)
    if tables.returncode == 1:
        return "table " + next(line.split()[0] for line in tables.stdout.splitlines() if "FAILED" in line)
    names = [line.split()[0] for line in (HERE / "proofs.txt").read_text().splitlines()
             if line.split()[1:2] == [module]]
    for name in names:
        proof = subprocess.run([sys.executable, HERE / "prove.py", "--rtl", rtl, "--timeout", "60", name],
                               capture_output=True, text=True)
        if proof.returncode == 1 and "no answer in time" not in proof.stdout:
            return "proof " + name
    return None


def main():
    missing = [tool for tool in ("iverilog", "yosys", "z3", "berkeley-abc") if shutil.which(tool) is None]
    if missing:
        print("SKIPPED: not found: " + ", ".join(missing))
        return 77
    chosen = [int(word) for word in sys.argv[1:]]
    survivors = 0
    for number, (name, old, new) in enumerate(read_mutations(), 1):
        if chosen and number not in chosen:
            continue
        with tempfile.TemporaryDirectory() as folder:
            rtl = pathlib.Path(folder) / "rtl"
            shutil.copytree(ROOT / "fpga/rtl", rtl)
            text = (rtl / name).read_text()
            if old not in text:
                print(f"{number:3} {name}: \"{old}\" is not in the file any more")
                survivors += 1
                continue
            (rtl / name).write_text(text.replace(old, new, 1))
            killer = caught_by(rtl, name[:-2])
        print(f"{number:3} {name:22} {killer or 'SURVIVED: ' + old}", flush=True)
        survivors += killer is None
    print(f"{survivors} survived")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
