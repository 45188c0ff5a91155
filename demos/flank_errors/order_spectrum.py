"""Orders of a pair with errors of manufacture: the picture docs/pictures/order_spectrum.png.

    python -m demos.flank_errors.order_spectrum [directory]

runs flank_errors.toml and draws its order spectrum. Mesh orders are multiples of 16, the pinion's teeth. Run-out of the pinion is order
1, of the wheel 2/3; pitch deviations fill the multiples of both, beside the mesh orders as sidebands; 37 waves on the pinion's
flanks are order 37. Orders of neither gear alone come from both teeth that meet, and repeat with the hunting tooth.
"""

from __future__ import annotations

import sys
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg

from fenics_gears.scene.read import load_scene
from fenics_gears.show.panels import DOTS_PER_INCH
from fenics_gears.show.spectrum import order_spectrum
from fenics_gears.simulation import simulate

HERE = Path(__file__).parent
PICTURES = HERE.parents[1] / "docs" / "pictures"


def main(directory: Path) -> Path:
    """Run the scene, draw its orders into a directory, and return the file."""
    figure = order_spectrum(simulate(load_scene(HERE / "flank_errors.toml")))
    file = directory / "order_spectrum.png"
    FigureCanvasAgg(figure)
    figure.savefig(file, dpi=DOTS_PER_INCH, metadata={"Software": None})
    return file


if __name__ == "__main__":
    print(main(Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES))
