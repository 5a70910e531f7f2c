#!/usr/bin/env python3
"""Keeps the tables of errors in README.md and docs/models.md, and the README's plot of them, to a report.

usage: error_tables.py FOLDER [--check]
  FOLDER   of `torsion report --out FOLDER`, not --quick
  --check  changes nothing; names the errors that are not the report's and fails if there are any. Times of steps,
           and the plot, which has them, depend on the machine and are not looked at.
"""
import csv
import pathlib
import re
import sys

DOCS = pathlib.Path(__file__).resolve().parent
CUBE = ("ball_on_cube_nu30", "ball_on_cube_nu49")
# Of a case: contact model, body model, cells.
PAPER = ("paper", "skeleton", "256")
MDR = ("mdr", "none", "256")
MDR_COMPLIANCE = ("mdr", "compliance", "256")
PATCH = ("patch", "none", "144")
PATCH_COMPLIANCE = ("patch", "compliance", "144")
PATCH_FINE = ("patch", "compliance", "256")


def row_of_readme(models):
    # The half-space deflects as one: it has no other body model.
    alone = (models[0], "none", models[2])
    return [("step", CUBE[0], models), ("error", ("sphere_twist",), alone), ("error", CUBE[:1], models),
            ("error", ("compass_on_ellipsoid",), models)]


def row_of_models(*cases):
    return [("error", cases, models) for models in (MDR, MDR_COMPLIANCE, PATCH, PATCH_COMPLIANCE, PATCH_FINE)]


def row_of_half_space(*cases):
    """It deflects as one: with body model compliance nothing else would."""
    models = (MDR, None, PATCH, None, ("patch", "none", "256"))
    return [("error", cases, of) if of else ("none",) for of in models]


# First column of a table's row -> the others.
TABLES = {
    DOCS.parent / "README.md": {
        "`paper` (the paper's equations), `skeleton`": row_of_readme(PAPER),
        "`mdr` (springs with history)": row_of_readme(MDR),
        "`mdr`, `compliance` (the body's own, precomputed)": row_of_readme(MDR_COMPLIANCE),
        "`patch` 12 x 12 cells, `compliance`": row_of_readme(PATCH_COMPLIANCE),
        "`patch` 16 x 16 cells, `compliance`": row_of_readme(PATCH_FINE),
    },
    DOCS / "models.md": {
        "ball on a half-space: turned / sliding and turning (16 x 16 alone)": row_of_half_space(
            "sphere_twist", "sphere_slide_and_spin"),
        "ball on the paper's cube, nu 0.3 / 0.49": row_of_models(*CUBE),
        "compass on ellipsoid, two regions": row_of_models("compass_on_ellipsoid"),
        "mallet on ellipsoid": row_of_models("mallet_on_ellipsoid"),
        "deep press, a / R = 0.5, linear body": row_of_models("large_strain_linear"),
        "the same, neo-Hookean": row_of_models("large_strain"),
        "soft column, contact 0.4 of its width": row_of_models("soft_column"),
        "column twelve times as high as wide, on its end": row_of_models("slender_column"),
        "wall a tenth as thick as high, on its edge": row_of_models("plate_on_edge"),
        "bonded layer, 1.7 times as thick as the contact's radius": row_of_models("thin_layer"),
    },
}


def read_report(folder):
    with open(folder / "report.csv", newline="", encoding="utf-8") as file:
        return {(row["scene"], row["contact_model"], row["body_model"], row["cells"]): row for row in csv.DictReader(file)}


def percent(error):
    return f"{100 * error:.0f}" if error >= 0.0995 else f"{100 * error:.1f}"


def cell_of(report, column):
    if column[0] == "none":
        return "\u2013"
    kind, cases, models = column
    if kind == "step":
        return f"{float(report[(cases, *models)]['step_us_median']):.0f} us"
    errors = []
    for case in cases:
        row = report[(case, *models)]
        errors.append(max(float(row[field]) for field in ("force_error", "torque_error") if row[field]))
    return " / ".join(percent(error) for error in errors) + " %"


def renewed(path, rows, report):
    """@return the page's lines with the report's errors, and what differs: texts"""
    lines, differences = [], []
    left = dict(rows)
    for line in path.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else [""]
        columns = left.pop(cells[0], None)
        if columns:
            new = [cell_of(report, column) for column in columns]
            if len(cells) != 1 + len(new):
                sys.exit(f"{path.name}: {cells[0]}: {len(cells) - 1} columns, expected {len(new)}")
            for old, now, column in zip(cells[1:], new, columns):
                if old != now and column[0] == "error":
                    differences.append(f"{path.name}: {cells[0]}: {old}, the report has {now}")
            line = "| " + " | ".join([cells[0], *new]) + " |"
        lines.append(line)
    if left:
        sys.exit(f"{path.name}: no row {', '.join(left)}")
    return "\n".join(lines) + "\n", differences


def renew_front(folder):
    """The plot of speed against error over all cases with finite bodies."""
    text = (folder / "report.html").read_text(encoding="utf-8")
    plots = re.findall(r"(<svg .*?</svg>)\s*<figcaption>(.*?)</figcaption>", text, re.DOTALL)
    front = next((plot for plot, caption in plots if "with finite bodies" in caption), None)
    if front is None:
        sys.exit("report.html: no plot of all cases with finite bodies")
    width, height = re.search(r'viewBox="0 0 (\d+) (\d+)"', front).groups()
    namespaces = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" color="black" '
    background = f'<rect width="{width}" height="{height}" fill="white"/>'
    front = front.replace("<svg ", "<svg " + namespaces, 1).replace(">", ">" + background, 1)
    (DOCS / "images" / "front.svg").write_text(front + "\n", encoding="utf-8")


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--check"]
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    folder = pathlib.Path(arguments[0])
    found = []
    for path, rows in TABLES.items():
        try:
            text, differences = renewed(path, rows, read_report(folder))
        except OSError as error:
            sys.exit(f"{error.filename}: {error.strerror}: run torsion report --out {folder} first")
        except KeyError as error:
            sys.exit(f"{folder}/report.csv: no row {error}: run torsion report without --quick")
        found += differences
        if "--check" not in sys.argv:
            path.write_text(text, encoding="utf-8")
    if "--check" not in sys.argv:
        renew_front(folder)
    elif found:
        sys.exit("\n".join(found))


main()
