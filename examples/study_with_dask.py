"""A study over workers of Dask: here two processes of this machine; with the address of a scheduler, a cluster.

    python3 study_with_dask.py scenes/ball_on_cube.gltf [tcp://SCHEDULER:8786]
"""
import itertools
import sys

import numpy as np
from distributed import Client, LocalCluster

MODULI = np.geomspace(1e4, 1e6, 6)
FRICTIONS = [0.3, 0.6, 0.9]


def run(path, modulus, friction):
    """One run, wherever it is: the numbers of a row."""
    import torsion

    scene = torsion.load(path)
    body = scene[scene.bodies[0]]
    body.youngs_modulus = modulus
    body.static_friction = body.dynamic_friction = friction
    model = torsion.build(scene, contact_model="mdr", body_model="none")
    simulation = torsion.Simulation(model)
    trace = simulation.run(scene.animation())
    return {"youngs_modulus": modulus, "friction": friction, "most_couple": abs(trace["couple"]).max(),
            "work": float(simulation.work()), "hash": simulation.hash}


def main():
    path = sys.argv[1]
    values = list(itertools.product(MODULI, FRICTIONS))
    cluster = None if len(sys.argv) > 2 else LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with Client(sys.argv[2] if cluster is None else cluster) as client:
        rows = client.gather(client.map(run, [path] * len(values), *zip(*values)))
        workers = len(client.scheduler_info()["workers"])
    if cluster is not None:
        cluster.close()
    for row in rows:
        print(f"E {row['youngs_modulus']:9.3g} Pa, mu {row['friction']}: couple {1e3 * row['most_couple']:.3f} mN m, "
              f"work {1e3 * row['work']:.3f} mJ")
    print(f"{len(rows)} runs on {workers} workers")
    # The same bits as in this process.
    assert run(path, *values[7])["hash"] == rows[7]["hash"]


if __name__ == "__main__":
    main()
