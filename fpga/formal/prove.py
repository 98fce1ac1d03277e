#!/usr/bin/env python3
"""Proves the claims that stand in fpga/rtl/*.v under FORMAL.

usage: prove.py [--rtl FOLDER] [--work FOLDER] [--timeout SECONDS] [NAME...]

proofs.txt lists the proofs. Needs yosys (with yosys-smtbmc), z3 and berkeley-abc. Exit status: 0 all proven,
1 something is not, 77 a tool is missing (said on stdout)."""

import argparse
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent


def read_proofs():
    proofs = []
    for line in (HERE / "proofs.txt").read_text().splitlines():
        words = line.split("#")[0].split()
        if words:
            proofs.append((words[0], words[1], words[2], words[3:]))
    return proofs


def run(command, folder, timeout):
    """Exit status and text of a command; the whole family of its processes ends with it."""
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               start_new_session=True)
    try:
        text = process.communicate(timeout=timeout)[0]
        return process.returncode, text
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # yosys-smtbmc would leave its solver running
        process.wait()
        return None, "no answer in time"


def read_design(rtl, module, parameters):
    macros = " ".join(word for word in parameters if word.startswith("-D"))
    chparam = " ".join("-set " + word.replace("=", " ") for word in parameters if not word.startswith("-D"))
    claims = "-sv" if "-DFORMAL_TOP" in macros else "-formal"  # of the top alone, or of the block
    script = f"read_verilog {claims} {macros} -I{rtl} {' '.join(str(file) for file in sorted(rtl.glob('*.v')))}; "
    if chparam:
        script += f"chparam {chparam} {module}; "
    return script + f"prep -top {module} -flatten; async2sync; dffunmap; "


def prove_pdr(design, folder, timeout):
    script = design + ("delete -output; delete t:$cover; memory_map; opt -full -nodffe -nosdff; techmap; "
                       "opt -fast -nodffe -nosdff; dffunmap; abc -g AND -fast; opt_clean; write_aiger -I -B -zinit d.aig")
    status, text = run(["yosys", "-q", "-p", script], folder, timeout)
    if status != 0:
        return False, text
    _, text = run(["berkeley-abc", "-c", f"read_aiger d.aig; fold; strash; pdr -T {timeout}"], folder, timeout + 10)
    return "Property proved" in text, text  # its exit status is always 0


def prove_induct(design, solver, depth, folder, timeout):
    status, text = run(["yosys", "-q", "-p", design + "delete t:$cover; write_smt2 -wires d.smt2"], folder, timeout)
    if status != 0:
        return False, text
    for extra in (["-i"], []):  # the step, then the base case
        command = ["yosys-smtbmc", "-s", solver, "-t", depth, *extra, "d.smt2"]
        status, text = run(command, folder, timeout)
        if status != 0:
            return False, text
    return True, text


def prove(proof, rtl, folder, timeout):
    _, module, engine, parameters = proof
    design = read_design(rtl, module, parameters)
    if engine == "pdr":
        return prove_pdr(design, folder, timeout)
    solver, depth = engine.split("-")
    return prove_induct(design, solver, depth, folder, timeout)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--rtl", type=pathlib.Path, default=HERE.parent / "rtl")
    parser.add_argument("--timeout", type=int, default=300)
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    missing = [tool for tool in ("yosys", "yosys-smtbmc", "z3", "berkeley-abc") if shutil.which(tool) is None]
    if missing:
        print("SKIPPED: not found: " + ", ".join(missing))
        return 77
    failed = 0
    for proof in read_proofs():
        if arguments.names and proof[0] not in arguments.names:
            continue
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            proven, text = prove(proof, arguments.rtl.resolve(), folder, arguments.timeout)
        print(f"{proof[0]:20} {proof[2]:10} {'proven' if proven else 'NOT PROVEN':10} {time.monotonic() - start:.1f} s",
              flush=True)
        if not proven:
            failed += 1
            print("\n".join(text.splitlines()[-25:]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
