"""What must hold of gears resolved over the face, into docs/evidence/third_dimension.md: `python -m
tests.benchmarks.third_dimension [NAMES]`."""
