"""The numbers of a result that goals and constraints may name, and what a scene needs to have them."""

from collections.abc import Mapping, Sequence
from typing import Any

from fenics_gears import HARMONIC_NAMES, OVERALL, Scene
from fenics_gears.many_runs import LARGEST_OF_SETS, NUMBERS, OF_TRAINS, OVER_FACE, RESULT_ATTRIBUTES

ERROR = "peak_to_peak_transmission_error"
# Of trains, in urad of the last shaft.
STEADY = "a constant speed: leave [speed_ramp] out"
OVERALL_ERROR = f"peak_to_peak_{OVERALL}"
# The sum of orders by the weights of [orders]; of a pair under this name.
WEIGHTED = "weighted_orders"
MESH = "mesh"
ROOT = ("largest_root_stress_pinion", "largest_root_stress_wheel")
ON_SHAFTS = ("largest_bearing_force",)
NAMES = (
    ERROR, OVERALL_ERROR, WEIGHTED, *HARMONIC_NAMES, "max_normal_force", "largest_pair_force",
    "dynamic_factor_by_force", "dynamic_factor_by_stress", "peak_contact_pressure",
    *ROOT, "friction_loss", *OVER_FACE, *ON_SHAFTS, *LARGEST_OF_SETS,
)  # fmt: skip


def order_name(mesh: str, harmonic: int) -> str:
    """What the amplitude of a harmonic is called among the numbers of a run: of a stage's meshes in the lag of the last
    shaft, or of a pair."""
    return HARMONIC_NAMES[harmonic - 1] if mesh == MESH else f"order {harmonic} of {mesh}"


def weighted_orders(weights: Mapping[str, Sequence[float]], numbers: Mapping[str, float]) -> float | None:
    """The sum of the orders of a run by their weights; None where it lacks one of them."""
    every = [
        (weight, numbers.get(order_name(mesh, harmonic)))
        for mesh, own in weights.items()
        for harmonic, weight in enumerate(own, start=1)
        if weight > 0.0
    ]
    if any(amplitude is None for _, amplitude in every):
        return None
    return float(sum(weight * amplitude for weight, amplitude in every if amplitude is not None))


def unit_and_words(name: str, of_train: bool = False) -> tuple[str, str]:
    """Unit and meaning of a number; transmission errors are lengths along the line of action."""
    if name == WEIGHTED:
        whole = "lag of the last shaft" if of_train else "transmission error"
        return "urad" if of_train else "um", f"sum of orders of the {whole}, by their weights"
    if name == ERROR:
        return "um", NUMBERS[ERROR][1]
    if name == OVERALL_ERROR:
        return "urad", OF_TRAINS[OVERALL_ERROR][1]
    if name in NUMBERS:
        return NUMBERS[name]
    if name in LARGEST_OF_SETS:
        return LARGEST_OF_SETS[name]
    attribute = next(each for each in RESULT_ATTRIBUTES if each.name == name)
    return attribute.units, attribute.meaning


def lacking(name: str, scene: Any) -> str:
    """What the scene, or one mesh of a train at least, lacks to have this number, completing "needs ..."; empty where
    it has it."""
    if name == WEIGHTED:
        ramped = not isinstance(scene, Scene) and scene.shafts.ramp is not None
        return STEADY if ramped else ""
    if name in LARGEST_OF_SETS:
        parts = () if isinstance(scene, Scene) else scene.parts
        return "" if any(part.shafts.carrier for part in parts) else 'a planetary set, kind = "planetary"'
    if isinstance(scene, Scene):
        return "a train of gears, [stages.NAME]" if name == OVERALL_ERROR else _lacking(name, scene)
    if name == OVERALL_ERROR:
        return ""
    lacks = [_lacking(name, mesh.scene) for mesh in scene.meshes]
    return lacks[0] if all(lacks) else ""


def _lacking(name: str, scene: Scene) -> str:
    if scene.speed_ramp is not None and name in HARMONIC_NAMES:
        return STEADY
    if name.startswith("dynamic_factor") and scene.inertia is None:
        return "[inertia]"
    if (name in ROOT or name == "dynamic_factor_by_stress") and not (
        scene.output.root_stress and scene.resolves_contact
    ):
        return "elastic teeth and [output] root_stress = true"
    if name == "peak_contact_pressure" and not scene.resolves_contact:
        return 'elastic teeth and accuracy.model = "elastic"'
    if name == "friction_loss" and scene.friction is None:
        return "[friction]"
    if name in OVER_FACE and not scene.three_dimensional:
        return "flanks that are resolved over the face, such as by [misalignment] or [lead_modifications]"
    if name in ON_SHAFTS and (scene.shafts is None or scene.shafts.sections is None):
        return "a shaft with sections"
    return ""
