"""A whole setting of `[accuracy]`: element, sizes and steps; the scene's own setting; the half-width in which sizes are
given."""

from dataclasses import dataclass, replace
from functools import lru_cache

from fenics_gears.contact.interpolation import AVERAGED
from fenics_gears.contact.window import ContactGrid
from fenics_gears.elasticity.element_sizes import DEFAULT_SIZES
from fenics_gears.model.model import model_of
from fenics_gears.model.resolution import CLOSEST_NODES, EVERY_STEP, ONCE
from fenics_gears.scene.accuracy import RESOLVED, SECTION_SIZE
from fenics_gears.scene.data import Accuracy, Scene


@dataclass(frozen=True)
class Setting:
    """Element; sizes along flank and between contact nodes and window (mm); body elements in parts of the default;
    steps, and the rest. `slices`, `layers`: of flanks resolved over the face, whose body elements are the swept
    section's; None in the plane."""

    element: str
    flank: float
    spacing: float
    length: float
    body: float
    steps: int
    interpolation: str = AVERAGED
    elastic_teeth: int | None = None
    condensation: str = ONCE
    slices: int | None = None
    layers: int | None = None

    @property
    def grid(self) -> ContactGrid:
        """Contact nodes at the wanted spacing, but not closer than the flank's elements resolve; wider windows hold the
        nodes of narrower ones."""
        spacing = max(self.spacing, CLOSEST_NODES * self.flank / self.order)
        cells = max(2, 2 * round(self.length / (2.0 * spacing)))
        return ContactGrid(cells * spacing, cells + 1, self.interpolation)

    @property
    def order(self) -> int:
        return 2 if self.element.endswith("2") else 1

    def accuracy(self, module: float) -> Accuracy:
        """The setting as `[accuracy]` has it; `module` in mm."""
        remeshed = self.condensation == EVERY_STEP
        return Accuracy(
            element=self.element,
            flank_element_size=self.flank,
            contact_length=self.grid.length,
            contact_nodes=self.grid.nodes,
            steps_per_mesh_cycle=self.steps,
            body_element_size=self.body * body_size(self.order, self.slices is not None) * module,
            interpolation=None if remeshed else self.interpolation,
            elastic_teeth=self.elastic_teeth,
            condensation=self.condensation,
            slices=self.slices,
            layers=self.layers,
        )

    def of(self, scene: Scene) -> Scene:
        return replace(scene, accuracy=self.accuracy(scene.gears.module))

    @property
    def words(self) -> str:
        """The setting for a label in a picture."""
        teeth = "" if self.elastic_teeth is None else f", teeth {self.elastic_teeth}"
        collocated = "" if self.interpolation == AVERAGED else f", {self.interpolation}"
        remeshed = "" if self.condensation == ONCE else f", condensed {self.condensation}"
        face = "" if self.slices is None else f", {self.slices} slices, {self.layers} layers"
        return (
            f"{self.element} {self.flank:.3g} mm, {self.grid.nodes} nodes, {self.steps} steps, body"
            f" x{self.body:.3g}{face}{collocated}{teeth}{remeshed}"
        )


def body_size(order: int, over_face: bool) -> float:
    return SECTION_SIZE if over_face else DEFAULT_SIZES[order].body


def half_width(scene: Scene) -> float:
    """The contact half-width (mm) in which sizes are given: Hertz's, within bounds, for it vanishes with the load."""
    size = default_setting(scene).flank
    hertz = model_of(without_settings(scene)).resolution.half_width
    return min(max(hertz, RESOLVED * size), scene.fineness.elements_per_half_width * size)


@lru_cache(maxsize=4)
def default_setting(scene: Scene) -> Setting:
    """The whole setting that the program chooses where a scene has none of its own."""
    return own_setting(without_settings(scene))


def own_setting(scene: Scene) -> Setting:
    """The setting that the scene has, its defaults included."""
    model = model_of(scene)
    resolution = model.resolution
    slices, layers = model.slices_and_layers
    grid = resolution.contact_grid
    size = resolution.body_element_size
    usual = body_size(resolution.order, slices is not None) * scene.gears.module
    body = 1.0 if size is None else size / usual
    return Setting(
        resolution.element, resolution.flank_element_size, grid.spacing, grid.length, body,
        resolution.steps_per_mesh_cycle,
        grid.interpolation, resolution.elastic_teeth, slices=slices, layers=layers,
    )  # fmt: skip


def without_settings(scene: Scene) -> Scene:
    """The scene with the settings that the program chooses."""
    return replace(scene, accuracy=Accuracy())
