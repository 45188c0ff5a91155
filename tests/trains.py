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
