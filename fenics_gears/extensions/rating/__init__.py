"""Load capacity of a computed pair: by the formulas of ISO 6336:2006, and by the loads and stresses of the run, side by
side."""
