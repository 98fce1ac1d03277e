#!/usr/bin/env python3
"""A part like a ceramic core, its CAD and a scan of it as it came out of the furnace; and how far contours are from where they belong.

    part.py make OUT                 cad.xyz, scan.xyz, contours.json (60, on the CAD), true.json (the same on the part)
    part.py far TRUE FILE [T.json]   largest and rms distance of the contours in FILE, moved by T.json, from those in TRUE

Contours lie in three areas whose directions spread over 13.97, 15.82 and 13.03 degrees. The part shrank by 0.6 %, bent by up to 0.2 mm, and
lies turned by 3.4 degrees and 5.4 mm off; the scan has 10 um of noise in every coordinate. All numbers come from one counter: no two runs differ.
"""
import json
import math
import sys
from pathlib import Path

AREAS = [  # contours, first and last azimuth or elevation, length of the arc, middle, along z or along x
    {"count": 18, "from": -19.9, "to": -5.93, "arc": 12, "middle": (0, 0, 5), "turns": "azimuth"},
    {"count": 24, "from": 22.09, "to": 37.91, "arc": 95, "middle": (14, 1.5, 60), "turns": "elevation"},
    {"count": 18, "from": 6.87, "to": 19.9, "arc": 12, "middle": (28, 0, 5), "turns": "azimuth"},
]
PLATES = [  # corner, two sides, outward
    ((-15, 0, -8), (60, 0, 0), (0, 30, 0), (0, 0, -1)),
    ((-15, 5, -8), (0, 25, 0), (0, 0, 40), (-1, 0, 0)),
    ((45, 5, -8), (0, 25, 0), (0, 0, 40), (1, 0, 0)),
    ((-15, 30, -8), (60, 0, 0), (0, 0, 110), (0, 1, 0)),
]
SHRINK, NOISE_MM = 0.994, 0.01
TURN_RAD, AXIS, SHIFT_MM = 0.06, (1, 2, -1.5), (3, -4, 2)


class Dice:
    """SplitMix64."""

    def __init__(self):
        self.count = 0

    def unit(self):
        self.count += 1
        z = self.count * 0x9E3779B97F4A7C15 & (1 << 64) - 1
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & (1 << 64) - 1
        z = (z ^ z >> 27) * 0x94D049BB133111EB & (1 << 64) - 1
        return ((z ^ z >> 31) >> 11) * 2.0**-53

    def normal(self):
        return math.sqrt(-2 * math.log(1 - self.unit())) * math.cos(2 * math.pi * self.unit())


def add(a, b, by=1.0):
    return tuple(x + by * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return tuple(x / math.hypot(*a) for x in a)


def normal_at(area, degrees):
    azimuth, elevation = (degrees, 0) if area["turns"] == "azimuth" else (0, degrees)
    azimuth, elevation = math.radians(azimuth), math.radians(elevation)
    return (math.cos(elevation) * math.sin(azimuth), -math.cos(elevation) * math.cos(azimuth), math.sin(elevation))


def on_area(area, along, s):
    """Point and normal at `along` (0 to 1) the arc and s mm along its line, which sags by 0.2 mm in 2 mm."""
    degrees = area["from"] + (area["to"] - area["from"]) * along
    radius = area["arc"] / math.radians(abs(area["to"] - area["from"]))
    here, middle = normal_at(area, degrees), normal_at(area, (area["from"] + area["to"]) / 2)
    line = (0, 0, 1) if area["turns"] == "azimuth" else (1, 0, 0)
    point = add(add(add(area["middle"], here, radius - s * s / 20), middle, -radius), line, s)
    return point, unit(add(here, line, s / 10))


def anywhere(dice):
    if dice.unit() < 0.5:
        area = AREAS[min(2, int(3 * dice.unit()))] if dice.unit() < 0.5 else AREAS[1]
        return on_area(area, 1.1 * dice.unit() - 0.05, 6 * dice.unit() - 3)
    corner, first, second, outward = PLATES[min(3, int(4 * dice.unit()))]
    return add(add(corner, first, dice.unit()), second, dice.unit()), outward


def on_part(point):
    """Where a point of the CAD has come to lie."""
    p = tuple(SHRINK * x for x in point)
    p = (p[0], p[1] + 0.15 * ((p[2] - 45) / 50) ** 2, p[2])
    return add(turned(p), SHIFT_MM)


def turned(v):
    axis, c, s = unit(AXIS), math.cos(TURN_RAD), math.sin(TURN_RAD)
    along = sum(a * b for a, b in zip(axis, v))
    return add(add(tuple(c * x for x in v), cross(axis, v), s), axis, along * (1 - c))


def rounded(v):
    return [round(x, 6) + 0.0 for x in v]


def contours():
    made = []
    for area in AREAS:
        for i in range(area["count"]):
            along = i / (area["count"] - 1)
            points = [on_area(area, along, k / 10)[0] for k in range(-20, 21)]
            made.append({"id": len(made) + 1, "points": points, "direction": on_area(area, along, 0)[1]})
    return made


def write_contours(path, all_of_them):
    text = [json.dumps({**c, "points": [rounded(p) for p in c["points"]], "direction": rounded(c["direction"])}) for c in all_of_them]
    path.write_text('{"contours":[\n' + ",\n".join(text) + "\n]}\n")


def write_points(path, points):
    path.write_text("".join(" ".join(f"{x:.6f}" for x in row) + "\n" for row in points))


def make(out):
    out.mkdir(parents=True, exist_ok=True)
    dice = Dice()
    write_points(out / "cad.xyz", [point + normal for point, normal in (anywhere(dice) for _ in range(40_000))])
    write_points(out / "scan.xyz", [tuple(x + NOISE_MM * dice.normal() for x in on_part(anywhere(dice)[0])) for _ in range(20_000)])
    on_cad = contours()
    write_contours(out / "contours.json", on_cad)
    there = [{**c, "points": [on_part(p) for p in c["points"]], "direction": turned(c["direction"])} for c in on_cad]
    write_contours(out / "true.json", there)


def far(true, file, transform=None):
    matrix = json.loads(Path(transform).read_text())["transform"] if transform else [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]
    wanted = {c["id"]: c["points"] for c in json.loads(Path(true).read_text())["contours"]}
    squares, most, count = 0.0, 0.0, 0
    for contour in json.loads(Path(file).read_text())["contours"]:
        for point, want in zip(contour["points"], wanted[contour["id"]]):
            here = [sum(row[k] * point[k] for k in range(3)) + row[3] for row in matrix[:3]]
            away = math.dist(here, want)
            squares, most, count = squares + away * away, max(most, away), count + 1
    print(f"{1e3 * most:9.0f} um at most, {1e3 * math.sqrt(squares / count):9.0f} um rms")


if __name__ == "__main__":
    if sys.argv[1] == "make":
        make(Path(sys.argv[2]))
    else:
        far(*sys.argv[2:])
