"""Noise figures of a run, and its curves as sound; the commands ``gears listen`` and ``gears plot --spectrum``."""
