"""Modulus and friction of a rubber-like block from a ball that was pressed on it and turned to and fro.

data/ball_on_block.csv is by finite elements (3 MPa, friction 0.75) with one per cent of noise, in the columns that a
force sensor's log might have: mm, degrees, N, N mm. The program torsion does the fit.

    python3 fit_measured.py [fit.html]
"""
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).parent
program = os.environ.get("TORSION_PROGRAM", "torsion")

# Angles become quaternions; all else the program converts itself.
with tempfile.TemporaryDirectory() as folder:
    measured = pathlib.Path(folder) / "measured.csv"
    with open(here / "data" / "ball_on_block.csv", encoding="utf-8") as log, \
            open(measured, "w", encoding="utf-8", newline="") as out:
        rows = list(csv.DictReader(log))
        table = csv.writer(out)
        table.writerow(["time_s", "tool_x_m", "tool_y_m", "tool_z_m", "tool_qw", "tool_qx", "tool_qy", "tool_qz",
                        "press_N", "torque_Nmm"])
        for row in rows:
            half = math.radians(float(row["turn_deg"])) / 2
            table.writerow([row["time_s"], 0.0, 0.15 - 1e-3 * float(row["depth_mm"]), 0.0, math.cos(half), 0.0,
                            math.sin(half), 0.0, row["press_N"], row["torque_Nmm"]])
    words = [program, "fit", here / "data" / "ball_on_block.gltf", measured, "--free",
             "block.youngs_modulus,block.friction", "--column", "force_y_N=press_N", "--column",
             "torque_y_Nm=torque_Nmm*1e-3", "--json"]
    if len(sys.argv) > 1:
        words += ["--report", sys.argv[1]]
    found = json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)

for name, truth in (("block.youngs_modulus", 3e6), ("block.friction", 0.75)):
    value = found["parameters"][name]
    print(f"{name}: {value['value']:.5g}, 95 % from {value['low']:.5g} to {value['high']:.5g} (made with {truth:g})")
    assert abs(value["value"] - truth) < 0.02 * truth
print("\n".join(found["warnings"]) or "no warnings")
