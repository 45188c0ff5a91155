"""`gears effects`: run a scene with subsets of its effects, to see what each effect costs in time and changes in the
results."""
