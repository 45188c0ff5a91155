"""Gear materials by name: Young's modulus, MPa, Poisson's ratio, yield strength, MPa, of named grades, and where they
are from.

The least yield strengths are of quenched and tempered steel more than 40 and up to 100 mm thick. Other names stand for
many grades, and those of case-hardened steels would be the core's, not the flanks'.
"""

from __future__ import annotations

from fenics_gears.geometry.gear_data import Material

_ISO_6336 = "ISO 6336-2, table of the elasticity factor"
# The table has moduli alone; Poisson's ratios are common ones.
_PLASTICS = (
    "Encyclopedia of Physical Science and Technology, Plastics Engineering, Table I: short term, room temperature"
)
MATERIALS: dict[str, tuple[Material, str]] = {
    "steel": (Material(206e3, 0.3), "ISO 6336-1"),
    "C45 QT": (Material(206e3, 0.3, 370.0), "ISO 6336-1; yield strength EN ISO 683-1"),
    "42CrMo4 QT": (Material(206e3, 0.3, 650.0), "ISO 6336-1; yield strength EN ISO 683-2"),
    "34CrNiMo6 QT": (Material(206e3, 0.3, 800.0), "ISO 6336-1; yield strength EN ISO 683-2"),
    "cast steel": (Material(202e3, 0.3), _ISO_6336),
    "ductile cast iron": (Material(173e3, 0.3), _ISO_6336),
    "grey cast iron": (Material(118e3, 0.3), _ISO_6336),
    "tin bronze": (Material(113e3, 0.3), _ISO_6336),
    "cast tin bronze": (Material(103e3, 0.3), _ISO_6336),
    "POM": (Material(2.9e3, 0.35), _PLASTICS),
    "PA66": (Material(3.0e3, 0.39), _PLASTICS),
}
