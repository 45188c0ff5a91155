"""What the program was held against, on one page: `python -m tests.evidence [NAMES]` measures and writes
docs/evidence/index.md."""
