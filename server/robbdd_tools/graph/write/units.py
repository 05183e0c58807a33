"""Convert the units of the language to SI units. The graph contains only SI units."""

from math import pi

LENGTHS = {"mm": 0.001, "cm": 0.01, "m": 1.0}
ANGLES = {"rad": 1.0, "deg": pi / 180}
MASSES = {"kg": 1.0, "g": 0.001}
