"""``python -m fenics_gears`` is the same as the command ``gears``."""

import sys

from fenics_gears.cli import main

if __name__ == "__main__":
    sys.exit(main())
