"""Job files of the large pictures that benchmarks and slow tests compile."""

# A tube of 70 mm at 8 um, and a roller of 300 mm at 5 um.
TUBE = {"pixel_um": 8, "turn_slots": 1800, "encoder_lines": 11840, "interpolation_bits": 13, "max_ab_hz": 40_000_000, "seam_um": 0.5}
ROLLER = {"pixel_um": 5, "turn_slots": 2000, "encoder_lines": 10000, "interpolation_bits": 6, "max_ab_hz": 2_000_000, "seam_um": 5.0}

JOB = """[job]
title = "{title}"
mode = "rotary"
[laser]
seed_hz = 82_000_000
pulse_divider = 41
max_pulse_on_demand_hz = 16_400_000
[fpga]
clock_multiplier = 2
counter_bits = 32
[scanner]
pixel_pitch_um = {pixel_um}
slots_per_microvector = 20
turn_slots = {turn_slots}
{field}[rotary]
circumference_mm = {around_mm}
lines_per_revolution = {lines}
encoder_lines = {encoder_lines}
interpolation_bits = {interpolation_bits}
max_ab_hz = {max_ab_hz}
[image]
files = ["{files}"]
lines_along = "{along}"
fires = "white"
[limits]
seam_um = {seam_um}
"""


def large_job(title, machine, files, lines, along="rows", field_pixels=0):
    """The text of a job; field_pixels: how many pixels the field of the scanner holds, where the job is to describe one."""
    field = f"field_mm = {field_pixels * machine['pixel_um'] / 1000}\n" if field_pixels else ""
    return JOB.format(title=title, files=files, lines=lines, along=along, around_mm=lines * machine["pixel_um"] / 1000,
                      field=field, **machine)
