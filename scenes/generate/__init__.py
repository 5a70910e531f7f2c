"""Writes the scenes that ship with Torsion."""
