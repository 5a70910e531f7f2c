#!/usr/bin/python3
"""Regenerates results/*.csv: contact with friction by finite elements (GetFEM, gmsh).

usage: generate.py [--divisions N ...] [CASE ...]     without a case: all of them
Every value of --divisions is a mesh of its own with that many elements to a contact radius.
"""

import argparse
import resource
import time
from pathlib import Path

import getfem
import numpy as np

import cases

RESULTS = Path(__file__).parent / "results"


def write(path, header, rows):
    path.write_text(header + "\n" + "".join(
        ",".join(f"{value:.9g}" for value in row) + "\n" for row in rows))


def generate(name, case, divisions):
    start, used = time.time(), time.process_time()
    print(f"{name}, {divisions} elements to a contact radius", flush=True)
    rows, twist = cases.run(case, divisions, lambda line: print("  " + line, flush=True))
    stem = f"{name}_{divisions}"
    write(RESULTS / f"{stem}.csv",
          "step,depth_m,phi_rad,force_N,torque_Nm,contact_radius_m", rows)
    write(RESULTS / f"{stem}_field.csv", "r_m,twist_rad", twist)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2 ** 20
    print(f"  {time.process_time() - used:.0f} s of the processor in {time.time() - start:.0f} s, "
          f"at most {memory:.2f} GB so far", flush=True)


def main():
    all_cases = cases.all_cases()
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(all_cases))
    parser.add_argument("--divisions", type=int, nargs="+")
    arguments = parser.parse_args()
    unknown = set(arguments.cases) - set(all_cases)
    if unknown:
        parser.error(f"no such case: {', '.join(sorted(unknown))}; there are: "
                     + ", ".join(all_cases))
    getfem.util_trace_level(0)
    np.seterr(all="raise", under="ignore")
    RESULTS.mkdir(exist_ok=True)
    for name in arguments.cases or all_cases:
        for divisions in arguments.divisions or all_cases[name].divisions:
            generate(name, all_cases[name], divisions)


if __name__ == "__main__":
    main()
