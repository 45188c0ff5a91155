"""Maps of a pair over loads and speeds: Harris map, Campbell diagram, waterfalls; the command ``gears map``."""
