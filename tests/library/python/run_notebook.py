"""Runs the cells of a notebook in their order, as a kernel would, and shows what their last lines come to.

usage: run_notebook.py NOTEBOOK.ipynb
"""
import ast
import json
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    cells = [cell for cell in json.load(file)["cells"] if cell["cell_type"] == "code"]
names = {}
for number, cell in enumerate(cells):
    tree = ast.parse("".join(cell["source"]), f"cell {number + 1}")
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, f"cell {number + 1}", "exec"), names)
    if last is not None:
        value = eval(compile(ast.Expression(last.value), f"cell {number + 1}", "eval"), names)
        shown = value._repr_html_() if hasattr(value, "_repr_html_") else repr(value)
        assert shown
        print(f"cell {number + 1}: {len(shown)} characters")
