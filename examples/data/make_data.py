"""Makes ball_on_block.gltf and ball_on_block.csv: a ball pressed on a block and turned, by finite elements, with noise.

    python3 make_data.py
"""
import base64
import csv
import json
import math
import pathlib
import random
import sys

here = pathlib.Path(__file__).resolve().parent
root = here.parent.parent
sys.path.insert(0, str(root / "scenes"))
from generate import catalogue, shapes  # noqa: E402

HALF, RADIUS, NOISE, INTERVAL = 0.05, 0.05, 0.01, 0.02  # m, m, of the largest, s

# What a person would guess before the measurement.
GUESS = {"torsion_youngs_modulus": 1e6, "torsion_poisson_ratio": 0.49, "torsion_density": 1100.0,
         "torsion_static_friction": 0.4, "torsion_dynamic_friction": 0.4, "torsion_fixed": "bottom_face"}


def scene():
    gltf = catalogue.start("ball_on_block.bin", (0.25, 0.3, 0.35), (0.0, 0.08, 0.0))
    catalogue.body(gltf, "block", shapes.box((HALF, HALF, HALF), 12), (0.0, HALF, 0.0), "box", GUESS)
    gltf.node("ball", mesh=gltf.mesh("ball", shapes.ellipsoid((RADIUS,) * 3, 16), gltf.tool_material),
              translation=(0.0, 2 * HALF + RADIUS, 0.0),
              extras={"torsion_role": "tool", "torsion_shape": "sphere", "torsion_mass": 1.0,
                      "torsion_device": "mouse"})
    files = gltf.files("ball_on_block")
    document = json.loads(files["ball_on_block.gltf"])
    meshes = files["ball_on_block.bin"]
    document["asset"]["generator"] = "Torsion examples/data/make_data.py"
    document["buffers"] = [{"uri": "data:application/octet-stream;base64," + base64.b64encode(meshes).decode(),
                            "byteLength": len(meshes)}]
    (here / "ball_on_block.gltf").write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


def measurement():
    with open(root / "tests/reference/finite_elements/results/ball_on_cube_nu49_9.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    random.seed(1)
    largest = {key: max(abs(float(row[key])) for row in rows) for key in ("force_N", "torque_Nm")}

    def noisy(row, key):
        return float(row[key]) + random.gauss(0.0, NOISE * largest[key])

    with open(here / "ball_on_block.csv", "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["time_s", "depth_mm", "turn_deg", "press_N", "torque_Nmm"])
        table.writerow([0.0, -0.02, 0.0, f"{random.gauss(0.0, NOISE * largest['force_N']):.4f}", 0.0])
        for k, row in enumerate(rows):
            table.writerow([f"{INTERVAL * (k + 1):.3f}", f"{1e3 * float(row['depth_m']):.5f}",
                            f"{math.degrees(float(row['phi_rad'])):.5f}", f"{noisy(row, 'force_N'):.4f}",
                            f"{-1e3 * noisy(row, 'torque_Nm'):.4f}"])


if __name__ == "__main__":
    scene()
    measurement()
