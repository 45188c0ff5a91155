"""The attributes of a result: what each is, and when it is there. Tests compare the results of runs with this list.
Beside them there may be one attribute for each method of the solver, by the prefix ``RUNG``, and one for each setting
whose error was estimated, by the prefix ``ESTIMATED``."""

from dataclasses import dataclass

from fenics_gears.inputs.tree import GEARS

from .numbers import CUBICS, SOLVED, STEPS


@dataclass(frozen=True)
class ResultAttribute:
    """One attribute: its name, its units ("": a text, a switch), what it is, and ``when`` it is there ("": always)."""

    name: str
    units: str
    meaning: str
    when: str = ""


PER_WIDTH = "N/(mm um)"
OF_WHOLE_CYCLES = "a whole mesh cycle was run, at one speed"
WITH_TEETH = "the teeth are elastic"
WITH_SECANT = WITH_TEETH + " and `mesh_stiffness` is a number"
WITH_CONTACT = "the teeth are elastic and contact is resolved over nodes"
WITH_PRESSURE = "the teeth are elastic, contact is resolved over nodes and a node is loaded"
PAIR_LOADED = "the forces of the tooth pairs are determined and a pair is loaded"
WITH_STEPS = "at least one step was computed"
WITH_FRICTION = "`[friction]` and a load"
AFTER_LOSS = "contact was lost"
ASKED_FOR = "`[output] root_stress`"
WITH_INERTIA = "`[inertia]`, and either equal mesh cycles or `[output] root_stress`"
WITH_ROOT_STRESS = "`[output] root_stress` with `[inertia]`"
OVER_FACE = "the flanks are resolved over the face"
OVER_FACE_WITH_LOAD = "the flanks are resolved over the face and loaded"
OVER_FACE_WITH_FIELDS = "as `transverse_load_factor`, and contact fields are stored"
WITH_SECTIONS = "a shaft has `sections`"
WITH_ROLLING = "a bearing is `rolling`"
WITH_VIBRATIONS = "a shaft has `sections`, with `[inertia]`"
PROPOSED = (
    "a torque, and `[misalignment]` in the plane of action, bearings along the shafts or a web off mid-width, where a"
    " mesh cycle run with the proposal confirms a lower factor; not in studies"
)
WITH_FILES = "the scene names files (`[body_meshes]`, tables of `[flank_errors]`)"
WITH_TARGET = "`[accuracy] target`"
IN_STUDIES = "the run is a study's case"

OF_HARMONIC = "amplitude of the transmission error, along the line of action,"
_ROWS = (
    ("title", "", "the scene's title"),
    ("scene", "", "the text of the scene that was run; saved as a file it can be run again"),
    ("scene_name", "", "the name of the scene's file"),
    ("scene_folder", "", "the folder from which files are looked for that the scene names", WITH_FILES),
    ("scene_files", "", "a line for each of these files: a hash of what was read from it, and its name", WITH_FILES),
    ("fenics_gears_version", "", "version of this program"),
    ("numbers_version", "", "version of its numbers: two results of the same scene may differ where these do"),
    ("complete", "", "1 when the run reached its end, 0 when it failed or was interrupted before"),
    (
        "failed_afterwards",
        "",
        "a line for each thing that failed after the march: `dynamic factor`, `proposal of lead modifications`,"
        " `numbers of the run`, `judgement of the run`; a warning says why",
        "one did",
    ),
    (
        "stopped",
        "",
        "why it is not complete: `interrupted`, `failed`, or `not ended` (killed or still running)",
        "`complete` is 0",
    ),
    ("warnings", "", "warnings, one on each line"),
    (
        "settled_from",
        "s",
        "begin of the settled steps: of the start's vibration 0.1 % is left, in short runs 1 %",
        WITH_STEPS,
    ),
    ("settled_cycles", "1", "number of mesh cycles from `settled_from` to the end", WITH_STEPS),
    ("friction_coefficient", "1", "coefficient of friction of the run", "`[friction]`"),
    ("shown_cycles", "1", "number of mesh cycles at the end of the run that pictures show; for a speed ramp all"),
    ("mean_transmission_error", "rad", "mean over the settled steps but the last, which begins the next mesh cycle"),
    (
        "peak_to_peak_transmission_error",
        "rad",
        "peak-to-peak value over the settled steps; extremes may lie between steps",
    ),
    (
        "peak_to_peak_transmission_error_from",
        "",
        f"how the extremes were found: `{SOLVED}`, `{CUBICS}`, or `{STEPS}`",
        WITH_STEPS,
    ),
    ("largest_transmission_error_mesh_phase", "1", "mesh phase of the largest transmission error", WITH_STEPS),
    ("least_transmission_error_mesh_phase", "1", "mesh phase of the least transmission error", WITH_STEPS),
    (
        "base_radius_wheel",
        "mm",
        "base radius of the wheel: with it the transmission error is a length along the line of action",
    ),
    *(
        (f"transmission_error_harmonic_{n}", "um", f"{OF_HARMONIC} at {words} mesh frequency", OF_WHOLE_CYCLES)
        for n, words in enumerate(("the", "twice the", "three times the", "four times the", "five times the"), 1)
    ),
    ("rms_transmission_error", "um", "r.m.s. transmission error without its mean", OF_WHOLE_CYCLES),
    ("rms_normal_force", "N", "r.m.s. force of the drive less the coast flanks, without its mean", OF_WHOLE_CYCLES),
    ("mean_mesh_stiffness", PER_WIDTH, "c_gamma: mean of `mesh_stiffness` while the flanks touch", WITH_SECANT),
    ("mean_mesh_stiffness_tangent", PER_WIDTH, "mean of `mesh_stiffness_tangent`, for small vibrations", WITH_TEETH),
    (
        "single_pair_stiffness",
        PER_WIDTH,
        "c': largest `mesh_stiffness` while one tooth pair is loaded",
        WITH_SECANT + " in steps in which one pair is loaded",
    ),
    (
        "bore_twist_stiffness",
        PER_WIDTH,
        "about: stiffness along the line of action of both bodies that twist on the bores where they are held, without"
        " teeth; it is in all mesh stiffnesses",
        WITH_TEETH + ", on bores that are held",
    ),
    ("largest_pair_force", "N", "largest normal force of a tooth pair", PAIR_LOADED),
    ("largest_pair_force_mesh_phase", "1", "mesh phase of the largest normal force of a tooth pair", PAIR_LOADED),
    ("largest_pair_force_from", "", "how that was found, as `peak_to_peak_transmission_error_from`", PAIR_LOADED),
    ("peak_contact_pressure", "MPa", "peak contact pressure: maximum of `largest_contact_pressure`", WITH_CONTACT),
    ("peak_contact_pressure_time", "s", "time of the peak contact pressure", WITH_PRESSURE),
    ("peak_contact_pressure_mesh_phase", "1", "mesh phase of the peak contact pressure", WITH_PRESSURE),
    ("peak_contact_pressure_pair", "1", "number of the tooth pair with the peak contact pressure", WITH_PRESSURE),
    ("peak_contact_pressure_flank", "", "flanks with the peak contact pressure: `drive` or `coast`", WITH_PRESSURE),
    ("peak_contact_pressure_diameter", "mm", "diameter on the pinion at the peak contact pressure", WITH_PRESSURE),
    (
        "peak_contact_pressure_beside",
        "",
        "`start` or `end` of the pinion's active profile, where lines of contact end",
        "the peak contact pressure is where `largest_line_load_factor` leaves the end of a line of contact out",
    ),
    (
        "peak_edge_pressure",
        "MPa",
        "maximum of `largest_edge_pressure`, which does not converge",
        "a pair is in contact at an edge, within two Hertz half-widths of one, or near the ends of the face",
    ),
    (
        "peak_kink_pressure",
        "MPa",
        "maximum of `largest_kink_pressure`, which does not converge",
        "a pair is in contact within a Hertz half-width of the kink of a linear relief",
    ),
    ("overlap_ratio", "1", "overlap ratio of the common face; 0 for spur gears", OVER_FACE),
    ("total_contact_ratio", "1", "transverse contact ratio plus overlap ratio", OVER_FACE),
    (
        "face_load_factor",
        "1",
        "K_Hbeta: of the line load averaged over the mesh cycle, the largest away from the face's ends over the mean"
        " there",
        f"{OVER_FACE_WITH_FIELDS} of at least a mesh cycle; not where the face's ends alone carry",
    ),
    (
        "largest_line_load_factor",
        "1",
        "largest line load of a tooth pair, away from edges, over that of an even load on rigid gears in the worst"
        " position",
        f"{OVER_FACE_WITH_FIELDS}, and the load reaches away from edges",
    ),
    (
        "edge_line_load_factor",
        "1",
        "largest line load likewise, near the ends of the face and where lines of contact end at a tip or form circle",
        f"{OVER_FACE_WITH_FIELDS}, and an edge is loaded",
    ),
    *(
        (f"mean_axis_{kind}_{plane}", "um", f"mean of `axis_{kind}_{plane}`", WITH_SECTIONS)
        for kind in ("inclination", "offset")
        for plane in ("in_plane", "out_of_plane")
    ),
    (
        "natural_frequencies",
        "",
        "a line for each, with the mean tangent mesh stiffness, up to the modes of shafts that are counted: the"
        " frequency in Hz, then what moves",
        WITH_VIBRATIONS,
    ),
    ("largest_bearing_force", "N", "largest force of a shaft on one of its bearings", WITH_SECTIONS),
    ("largest_rolling_element_force", "N", "largest force of a ball or roller under the mean load", WITH_ROLLING),
    *(
        (f"proposed_{name}", unit, meaning, PROPOSED)
        for name, unit, meaning in (
            ("helix_slope", "um", "helix slope modification of the pinion, in place of its own"),
            ("crowning", "um", "crowning of the pinion with it, in place of its own"),
            (
                "face_load_factor",
                "1",
                "what a mesh cycle that was run with these two has, without inertia; the variable `proposed_line_load`,"
                " N/mm, is the line load of the mesh with them, mean over the mesh cycle",
            ),
        )
    ),
    (
        "transverse_load_factor",
        "1",
        "K_Halpha: largest share of a tooth pair, relative to that of even line load",
        OVER_FACE_WITH_LOAD,
    ),
    ("input_power", "W", "mean power of the driving gear", "a load and a speed"),
    ("friction_loss", "1", "friction loss between the flanks divided by the work of the driving gear", WITH_FRICTION),
    ("friction_power", "W", "mean power of the friction loss between the flanks", "`[friction]`, a load and a speed"),
    (
        "mesh_efficiency",
        "1",
        "efficiency of the mesh, without losses of bearings, oil and damping",
        WITH_FRICTION + ", and teeth that are neither wedged nor locked",
    ),
    ("contact_loss_count", "1", "number of contact losses of the drive flanks in the settled steps"),
    ("contact_loss_first", "s", "time of the first contact loss", AFTER_LOSS),
    ("contact_loss_longest", "s", "duration of the longest contact loss", AFTER_LOSS),
    ("contact_loss_share", "1", "share of the settled time without contact", AFTER_LOSS),
    ("contact_loss_opening", "mm", "largest gap between the drive flanks during a contact loss", AFTER_LOSS),
    (
        "dynamic_factor_by_force",
        "1",
        "dynamic factor: largest force of a tooth pair over that of the quasi-static run",
        WITH_INERTIA,
    ),
    (
        "dynamic_factor_by_stress",
        "1",
        "dynamic factor: largest root stress over that of the quasi-static run",
        WITH_ROOT_STRESS,
    ),
    ("quasi_static_pair_normal_force", "N", "largest force of a tooth pair in the quasi-static run", WITH_INERTIA),
    ("quasi_static_root_stress", "MPa", "largest root stress in the quasi-static run", WITH_ROOT_STRESS),
    (
        "dynamic_factor_unknown",
        "",
        "why the dynamic factors and the quasi-static values are missing",
        "`[inertia]`, if they are",
    ),
    *(
        attribute
        for gear in GEARS
        for attribute in (
            (f"largest_root_stress_{gear}", "MPa", f"largest root stress (tension) of the {gear}", ASKED_FOR),
            (f"largest_root_stress_{gear}_mesh_phase", "1", "mesh phase of this largest root stress", ASKED_FOR),
            (f"largest_root_stress_{gear}_pair", "1", "number of the tooth pair to which the tooth belongs", ASKED_FOR),
            (f"largest_root_stress_{gear}_fillet", "", "side of the tooth: `drive` or `coast`", ASKED_FOR),
        )
    ),
    ("element", "", "finite element used"),
    ("flank_element_size", "mm", "size of the elements on the flank"),
    ("contact_length", "mm", "contact length of a tooth pair"),
    ("contact_nodes", "1", "number of contact nodes of a tooth pair"),
    ("steps_per_mesh_cycle", "1", "time steps per mesh cycle"),
    ("condensation", "", "`once` or `every step`, see `accuracy.condensation`"),
    ("model", "", "model of the tooth contact, see `accuracy.model`"),
    ("target", "1", "the error allowed by `accuracy.target` (0.01 for 1 %)", WITH_TARGET),
    (
        "estimated_error",
        "1",
        "the largest estimated error of the curve and the peak-to-peak value of the transmission error, in three"
        " dimensions also of line load, face load factor and largest line load",
        WITH_TARGET,
    ),
    ("target_runs", "1", "number of test runs by which the settings were chosen", WITH_TARGET),
    ("slices", "1", "chosen number of slices of the common face", f"{WITH_TARGET}, and {OVER_FACE}"),
    ("layers", "1", "chosen number of layers of either gear's body", f"{WITH_TARGET}, and {OVER_FACE}"),
    ("target_remarks", "", "a remark on the choice, where a warning recommends other settings", WITH_TARGET),
    ("steps", "1", "number of time steps of the run"),
    ("newton_iterations_total", "1", "number of Newton iterations of the run"),
    ("time_choose", "s", "wall time of choosing settings", WITH_TARGET),
    ("time_mesh", "s", "wall time of meshing; 0 for gears from the cache"),
    ("time_condense", "s", "wall time of assembling and condensing"),
    ("time_compile", "s", "wall time of compiling"),
    ("time_march", "s", "wall time of the time stepping"),
    ("wall_time", "s", "wall time of the case", IN_STUDIES),
    ("case_key", "", "hash of everything the result of the case depends on", IN_STUDIES),
    ("case_values", "", "values of the swept fields, as JSON", IN_STUDIES),
)

RESULT_ATTRIBUTES = tuple(ResultAttribute(*row) for row in _ROWS)
