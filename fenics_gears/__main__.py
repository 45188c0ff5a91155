"""``python -m fenics_gears`` is the same as the command ``gears``."""

import sys

from fenics_gears.commands.cli import main

if __name__ == "__main__":
    sys.exit(main())
