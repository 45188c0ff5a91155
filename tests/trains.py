"""Trains for tests, with coarse elements."""

from pathlib import Path

from fenics_gears import train_from_text
from fenics_gears.scene.train import TrainScene

COARSE = 'steps_per_mesh_cycle = 20\nflank_element_size = "0.1 mm"'


def row_section(teeth, directions, module: int = 3, bore: int = 30) -> str:
    """The section of a row of gears, ten modules wide, directions in degrees, lengths in mm."""
    gears = ", ".join(f'{{ teeth = {each}, profile_shift = 0, bore_diameter = "{bore} mm" }}' for each in teeth)
    angles = ", ".join(f'"{each} deg"' for each in directions)
    return f"""
        [stages.row]
        kind = "row"
        module = "{module} mm"
        pressure_angle = "20 deg"
        face_width = "{10 * module} mm"
        gears = [{gears}]
        directions = [{angles}]
        material = "steel"
        """


def row(teeth, directions, torque: float, *, more: str = "", accuracy: str = "") -> TrainScene:
    """A row of gears of module 3 mm, directions in degrees, under a torque (N m) on the last one."""
    return train_from_text(
        f"""{row_section(teeth, directions)}
        [load]
        output_torque = "{torque} N m"
        [accuracy]
        {COARSE}
        {accuracy}
        {more}
        """
    )


def helical_row(
    teeth,
    directions,
    torque: float,
    *,
    helix: float = 15.0,
    hand: str = "right",
    poissons_ratio: float = 0.3,
    more: str = "",
) -> TrainScene:
    """Such a row over the face, its first gear of that hand; spur and in the plane without helix (deg) and `more`."""
    coarse = """
        slices = 4
        layers = 2
        body_element_size = "3 mm"
        steps_per_mesh_cycle = 12
        flank_element_size = "0.2 mm"
        """
    lean = f'helix_angle = "{helix} deg"\npinion_hand = "{hand}"\n' if helix else ""
    if not (helix or more):
        coarse = 'steps_per_mesh_cycle = 12\nflank_element_size = "0.2 mm"\n'
    steel = f'{{ youngs_modulus = "206e3 N/mm^2", poissons_ratio = {poissons_ratio} }}'
    text = row(teeth, directions, torque).text
    text = (
        text.replace('face_width = "30 mm"', 'face_width = "12 mm"')
        .replace('material = "steel"', f"{lean}material = {steel}\n{more}")
        .replace(COARSE, coarse)
    )
    return train_from_text(text)


def stage(name: str, module: float, teeth: tuple[int, int], more: str = "") -> str:
    """The section of a stage of two gears."""
    gears = "\n".join(
        f'{gear} = {{ teeth = {each}, profile_shift = 0.1, bore_diameter = "{module * each / 2} mm" }}'
        for gear, each in zip(("pinion", "wheel"), teeth)
    )
    return f"""
        [stages.{name}]
        module = "{module} mm"
        pressure_angle = "20 deg"
        face_width = "{10 * module} mm"
        {gears}
        material = "steel"
        {more}
        """


def two_stages(of_first: str = "", more: str = "") -> TrainScene:
    """Two stages on three shafts under 400 N m on the last one; `of_first`: more of the first stage."""
    stages = stage("first", 2.0, (20, 30), of_first) + stage("second", 3.0, (20, 40))
    return train_from_text(f'{stages}\n[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}\n{more}')


def gearbox_file(folder: Path) -> Path:
    """A scene file of such two stages."""
    file = folder / "gearbox.toml"
    stages = stage("first", 2.0, (20, 30)) + stage("second", 3.0, (20, 40))
    file.write_text(f'{stages}\n[load]\noutput_torque = "400 N m"\n[accuracy]\n{COARSE}\n\n')
    return file


COARSE_FACE = """
    slices = 4
    layers = 2
    body_element_size = "5 mm"
    steps_per_mesh_cycle = 8
    flank_element_size = "0.25 mm"
    """


def helical_stage(name: str, module: float, teeth: tuple[int, int], helix: float, more: str = "") -> str:
    """The section of a helical stage of two gears, eight modules wide, in directions that are not alike."""
    lean = f'helix_angle = "{helix} deg"\n{more}' if helix else more
    return stage(name, module, teeth, lean).replace(f"{10 * module} mm", f"{8 * module} mm")


def shaft_section(name: str, gears: dict[str, float], length: float, diameter: float, more: str = "") -> str:
    """The section of a shaft that bends, lengths in mm; `gears`: places of its gears."""
    carries = ", ".join(f'"{each}"' for each in gears)
    places = ", ".join(f'"{each} mm"' for each in gears.values())
    return f"""
        [shafts.{name}]
        carries = [{carries}]
        sections = [{{ length = "{length} mm", diameter = "{diameter} mm" }}]
        gears_at = [{places}]
        {more}
        """


def bearing_sections(name: str, places: tuple[float, ...], radial: float, axial: float) -> str:
    """Bearings of a shaft, N/mm; the first one holds it along its axis."""
    return "".join(
        f'[[shafts.{name}.bearings]]\nat = "{at} mm"\nradial_stiffness = "{radial!r} N/mm"\n'
        + (f'axial_stiffness = "{axial!r} N/mm"\n' if not number else "")
        for number, at in enumerate(places)
    )


def bent_two_stages(compliance: float | None = 1.0, more: str = "", helix: tuple[float, float] = (15.0, 20.0)):
    """Two stages whose intermediate shaft bends, of such a part of steel's compliance and that of its bearings; on
    rigid shafts where None."""
    text = helical_stage("first", 2.0, (18, 24), helix[0], 'direction = "20 deg"')
    text += helical_stage("second", 3.0, (24, 30), helix[1], 'direction = "-70 deg"')
    text += f'[load]\noutput_torque = "300 N m"\n[accuracy]\n{COARSE_FACE}\n{more}'
    if compliance is not None:
        steel = f'material = {{ youngs_modulus = "{206e3 / compliance!r} N/mm^2", poissons_ratio = 0.3 }}'
        text += shaft_section("middle", {"first.wheel": 35.0, "second.pinion": 100.0}, 150.0, 35.0, steel)
        text += bearing_sections("middle", (15.0, 135.0), 1e6 / compliance, 1e5 / compliance)
    return train_from_text(text)
