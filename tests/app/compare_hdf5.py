"""Compares the tables trace, regions and runs of a folder as CSV and as HDF5, both read by pandas."""
import pathlib
import sys
import warnings

import numpy as np
import pandas as pd

folder = pathlib.Path(sys.argv[1])
warnings.filterwarnings("ignore", message="object name is not a valid Python identifier")
for name in ("trace", "regions", "runs"):
    csv = pd.read_csv(folder / f"{name}.csv")
    hdf = pd.read_hdf(folder / f"{name}.h5", name)
    assert list(csv.columns) == list(hdf.columns), (list(csv.columns), list(hdf.columns))
    assert len(csv) == len(hdf) > 0, (name, len(csv), len(hdf))
    for column in csv.columns:
        if column == "step_us":  # another run's
            continue
        if hdf[column].dtype == object:
            texts = [value.decode() if isinstance(value, bytes) else value for value in hdf[column]]
            assert texts == [str(value) for value in csv[column]], column
        else:
            # CSV has nine digits.
            assert np.allclose(csv[column], hdf[column], rtol=1e-8, atol=0.0), column
    print(f"{name}: {len(csv)} rows, {len(csv.columns)} columns are the same")
