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


def gear_text(teeth: int, module: float) -> str:
    return f'{{ teeth = {teeth}, profile_shift = 0, bore_diameter = "{module * teeth / 2} mm" }}'


def mate(name: str, pinion: str, wheel: str, direction: float, module: float = 2.0, more: str = "") -> str:
    """The section of a stage whose gears are tables, or names of those of other stages."""
    return f"""
        [stages.{name}]
        module = "{module} mm"
        pressure_angle = "20 deg"
        face_width = "20 mm"
        pinion = {pinion}
        wheel = {wheel}
        material = "steel"
        direction = "{direction!r} deg"
        {more}
        """


def split_text(
    paths: int = 2,
    torque: float = 400.0,
    *,
    teeth: tuple[int, int, int, int] = (20, 40, 20, 40),
    of_shaft: str = "",
    accuracy: str = "",
    more: str = "",
) -> str:
    """Paths from one pinion to one wheel on its axis, evenly around it: in1, out1, in2 ...; `of_shaft`: of the last
    path's."""
    first, driven, driving, last = (gear_text(each, 2.0) for each in teeth)
    text = ""
    for path in range(paths):
        text += mate(f"in{path + 1}", '"in1.pinion"' if path else first, driven, 360.0 * path / paths)
    for path in range(paths):
        direction = (360.0 * path / paths + 180.0) % 360.0
        text += mate(f"out{path + 1}", driving, '"out1.wheel"' if path else last, direction)
    for path in range(paths):
        text += f'\n[shafts.path{path + 1}]\ncarries = ["in{path + 1}.wheel", "out{path + 1}.pinion"]\n'
    return f'{text}{of_shaft}\n[load]\noutput_torque = "{torque} N m"\n[accuracy]\n{COARSE}\n{accuracy}\n{more}'
