#!/usr/bin/env python3
"""Draws docs/timing.md, one figure in text a timing table.

usage: figures.py            writes the page
       figures.py --check    writes nothing; exit status 1 where the page is stale

Exit status 1, too, where a latency of fpga/regs/latencies.txt is in no table: nothing would measure it."""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE.parent / "regs"))
import generate

LATENCIES = generate.clocks_of(generate.read_latencies())
PAGE = HERE.parent.parent / "docs/timing.md"
WIDTH = 96  # clocks of a figure


def clock_of(text):
    """"88+2*SLOT_TO_GATE": a sum of products."""
    total = 0
    for term in text.split("+"):
        product = 1
        for factor in term.split("*"):
            product *= LATENCIES[factor] if factor in LATENCIES else int(factor)
        total += product
    return total


def read_table(path):
    about, block, rows = [], "", []
    for line in path.read_text().splitlines():
        if line.startswith("#"):
            about.append(line.lstrip("# "))
            continue
        line = line.split("#")[0].strip()
        if line.startswith("block"):
            block = line.split()[1]
        elif line:
            clock, rest = line.split(":", 1)
            cells = [dict(word.split("=") for word in half.split()) for half in rest.split("->")]
            rows.append((clock_of(clock), *cells))
    return about, block, rows


def draw(values, first, last, holds):
    """One character a clock: _ low, # high, a letter or digit for the n-th value of a wide signal, . not looked at."""
    wide = sorted({int(v, 0) for v in values.values()} - {0, 1})
    text, now = "", "_" if holds else "."
    for clock in range(first, last + 1):
        if clock in values:
            value = int(values[clock], 0)
            now = "_#"[value] if not wide else "_" if value == 0 else "=" if clock - 1 in values else "|"
            text += now
            now = now if holds else "."
            if wide and value:
                now = "=" if holds else "."
        else:
            text += now
    return text


def figure(rows):
    first, last = rows[0][0], min(rows[-1][0], rows[0][0] + WIDTH - 1)
    lines = []
    for side, holds, arrow in ((1, True, ">"), (2, False, "<")):
        names = list(dict.fromkeys(name for row in rows for name in row[side]))
        for name in names:
            values = {row[0]: row[side][name] for row in rows if name in row[side] and row[0] <= last}
            changes = [f"{clock}: {value}" for clock, value in values.items() if int(value, 0) > 1]
            note = "  " + ", ".join(changes[:6]) + (", ..." if len(changes) > 6 else "") if changes else ""
            lines.append(f"{arrow} {name:15} {draw(values, first, last, holds)}{note}")
    scale = "".join(str(clock // 10 % 10) if clock % 10 == 0 else "." for clock in range(first, last + 1))
    return [f"  {'clock':15} {scale}", *lines]


def main():
    text = ["# Timing of the board's blocks", "",
            "Drawn by `fpga/timing/figures.py` from `fpga/timing/*.txt`, the tables that model and Verilog are tested with. `>` is an",
            "input, `<` an output; `_` 0, `#` 1, `|` and `=` another value (listed at the end of the line), `.` not looked at. An input",
            "stands before the clock of its column, an output just after it; the scale shows the tens.", ""]
    unmeasured = set(LATENCIES)
    for path in sorted(HERE.glob("*.txt")):
        unmeasured -= set(re.findall(r"[A-Z_]{3,}", re.sub("#.*", "", path.read_text())))
        about, block, rows = read_table(path)
        text += [f"## {path.stem}: {block}", "", *about, "", "```", *figure(rows), "```", ""]
    if unmeasured:
        print("in no timing table: " + ", ".join(sorted(unmeasured)))
        return 1
    page = "\n".join(text)
    stale = not PAGE.exists() or PAGE.read_text() != page
    if stale and "--check" in sys.argv:
        print("docs/timing.md: stale; run fpga/timing/figures.py")
        return 1
    if stale:
        PAGE.write_text(page)
        print("docs/timing.md: written")
    return 0


if __name__ == "__main__":
    sys.exit(main())
