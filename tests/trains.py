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


def helical_paths(of_last: str = "", of_paths: tuple[str, str] = ("", ""), more: str = "") -> str:
    """Two paths as of split_text, over the face, whose gears are their own: two side by side on the first shaft and two
    on the last; what the last shaft and those of the paths have beside."""
    text = split_text(teeth=(20, 30, 20, 30), more=more).replace('"in1.pinion"', gear_text(20, 2.0), 1)
    text = text.replace('"out1.wheel"', gear_text(30, 2.0), 1)
    text = text.replace("face_width", 'helix_angle = "15 deg"\nface_width')
    coarse = (
        'slices = 3\nlayers = 2\nbody_element_size = "3 mm"\nsteps_per_mesh_cycle = 6\nflank_element_size = "0.2 mm"'
    )
    ends = '[shafts.first]\ncarries = ["in1.pinion", "in2.pinion"]\n'
    ends += f'[shafts.last]\ncarries = ["out1.wheel", "out2.wheel"]\n{of_last}\n'
    for path, own in enumerate(of_paths, 1):
        carries = f'carries = ["in{path}.wheel", "out{path}.pinion"]\n'
        text = text.replace(carries, carries + own)
    text = text.replace(COARSE, coarse).replace('face_width = "20 mm"', 'face_width = "10 mm"')
    return text.replace("[load]", f"{ends}[load]")


def bent_paths(compliance: float, of_last: str = "", more: str = "") -> str:
    """The same with both middle shafts bending, of such a part of steel's compliance and that of their bearings."""
    steel = f'material = {{ youngs_modulus = "{206e3 / compliance!r} N/mm^2", poissons_ratio = 0.3 }}\n'
    own = 'sections = [{ length = "80 mm", diameter = "25 mm" }]\ngears_at = ["20 mm", "55 mm"]\n' + steel
    of_paths = (
        own + bearing_sections(f"path{path}", (5.0, 75.0), 3e5 / compliance, 1e5 / compliance) for path in (1, 2)
    )
    return helical_paths(of_last, (*of_paths,), more)


def bent_ends(text: str, compliance: float) -> str:
    """Two such paths whose first and last shafts bend too: either carries two gears, and drive or load at its end."""
    steel = f'material = {{ youngs_modulus = "{206e3 / compliance!r} N/mm^2", poissons_ratio = 0.3 }}\n'
    for name, gears, place in (("first", "in{}.pinion", 0.0), ("last", "out{}.wheel", 90.0)):
        carries = ", ".join(f'"{gears.format(path)}"' for path in (1, 2))
        own = f'sections = [{{ length = "90 mm", diameter = "25 mm" }}]\ngears_at = ["30 mm", "60 mm"]\n{steel}'
        own += f'torque_at = "{place} mm"\n'
        text = text.replace(f"carries = [{carries}]\n", f"carries = [{carries}]\n{own}")
        text += bearing_sections(name, (10.0, 80.0), 3e5 / compliance, 1e5 / compliance)
    return text
