"""Other names of sections and fields that engineers use: looked up only for an unknown name, to suggest the right
one."""

from __future__ import annotations

from collections.abc import Iterable

# By section ("" for the sections themselves; a gear's own section also has the names of the section above): each name
# with its synonyms.
SYNONYMS: dict[str, dict[str, tuple[str, ...]]] = {
    "": {
        "gears": ("pair", "gear_pair", "gear", "geometry", "stage"),
        "load": ("torque", "loads", "loading"),
        "motion": ("speed", "kinematics", "operation"),
        "accuracy": ("mesh", "numerics", "solver", "settings", "resolution", "discretisation", "discretization"),
        "output": ("outputs", "results"),
        "inertia": ("mass", "masses", "inertias", "dynamics"),
        "shafts": ("torsion", "shaft_stiffness", "coupling"),
        "bearings": ("bearing_stiffness", "supports"),
        "friction": ("mu", "coulomb", "lubrication"),
        "tip_relief": ("relief", "profile_modification", "modification", "modifications", "ca", "c_alpha_a"),
        "root_relief": ("cf", "c_alpha_f", "foot_relief"),
        "lead_modifications": (
            "lead",
            "crowning",
            "flank_line_modifications",
            "helix_modifications",
            "lead_modification",
        ),
        "misalignment": ("shaft_misalignment", "axis_deviation", "parallelism", "skew"),
        "flank_errors": (
            "errors",
            "deviations",
            "pitch_errors",
            "profile_errors",
            "manufacturing_errors",
            "tolerances",
        ),
        "eccentricity": ("runout", "run_out", "radial_runout"),
        "coast_flanks": ("backlash", "back_flanks", "rear_flanks", "back_side"),
        "corner_contact": ("tip_contact", "tip_edge", "edge_radius", "premature_contact"),
        "torque_ripple": ("load_ripple", "varying_torque", "torque_fluctuation"),
        "speed_ramp": ("run_up", "coast_down", "ramp"),
        "body_meshes": ("meshes", "gear_meshes", "cracks", "crack"),
    },
    "gears": {
        "module": ("m", "mn", "m_n", "normal_module"),
        "pressure_angle": ("alpha", "alpha_n", "angle", "normal_pressure_angle"),
        "centre_distance": ("a", "aw", "a_w", "center_distance", "axis_distance", "distance"),
        "face_width": ("b", "width", "facewidth", "tooth_width"),
        "material": ("steel", "elasticity"),
        "backlash": ("jt", "j_t", "jwt", "j_wt", "jn", "j_bn", "play"),
        "tip_shortening": ("k", "tip_alteration", "topping", "tip_height_modification"),
        "helix_angle": ("beta", "helix", "angle_of_helix", "spiral_angle"),
        "pinion_hand": ("hand", "hand_of_helix", "helix_hand", "helix_direction"),
        "pinion": ("gear1", "gear_1", "driver", "driving"),
        "wheel": ("gear2", "gear_2", "driven", "gear"),
    },
    "gears.pinion": {
        "teeth": ("z", "number_of_teeth", "tooth_number"),
        "profile_shift": ("x", "addendum_modification", "shift", "profile_shift_coefficient"),
        "tip_diameter": ("da", "d_a", "outer_diameter", "outside_diameter", "addendum_diameter"),
        "root_diameter": ("df", "d_f", "foot_diameter", "dedendum_diameter"),
        "bore_diameter": ("bore", "di", "inner_diameter", "hub_diameter", "shaft_diameter"),
        "rack_tip_radius": (
            "rho_fp",
            "tool_tip_radius",
            "fillet_radius",
            "root_fillet_radius",
            "root_radius",
            "cutter_radius",
        ),
        "tooth_thickness": ("s", "sn", "s_n", "thickness", "circular_tooth_thickness", "chordal_thickness"),
        "base_tangent_length": ("w", "wk", "w_k", "span", "span_measurement", "span_width"),
        "spanned_teeth": ("k", "span_teeth", "number_of_spanned_teeth"),
        "dimension_over_balls": (
            "md",
            "m_d",
            "mdk",
            "m_dk",
            "ball_size",
            "over_balls",
            "over_pins",
            "dimension_over_pins",
            "measurement_over_pins",
        ),
        "ball_diameter": ("dm", "d_m", "pin_diameter", "dp", "wire_diameter"),
        "rack": ("tool", "hob", "basic_rack", "reference_profile"),
    },
    "gears.rack": {
        "profile": ("type", "standard"),
        "addendum": ("hap", "h_ap"),
        "dedendum": ("hfp", "h_fp"),
        "tip_radius": ("rho_fp", "root_radius", "fillet_radius"),
    },
    "gears.material": {
        "youngs_modulus": ("e", "modulus", "elastic_modulus", "modulus_of_elasticity", "young", "e_modulus"),
        "poissons_ratio": ("nu", "poisson", "poisson_ratio", "mu"),
        "yield_strength": ("re", "rp02", "yield", "yield_stress", "yield_point"),
    },
    "load": {
        "wheel_torque": ("torque", "t2", "output_torque", "moment", "couple", "load_torque"),
        "pinion_torque": ("t1", "input_torque", "driving_torque"),
        "power": ("p", "kw", "rated_power"),
    },
    "motion": {
        "mesh_frequency": ("frequency", "f", "gear_mesh_frequency", "tooth_frequency", "fz"),
        "pinion_speed": (
            "speed",
            "n",
            "n1",
            "rpm",
            "rotational_speed",
            "input_speed",
            "rotation_speed",
            "angular_velocity",
            "omega",
            "wheel_speed",
        ),
        "mesh_cycles": ("cycles", "duration", "time", "periods", "revolutions"),
        "settling_time": ("settling", "settle", "run_in_time", "transient_time", "start_up_time"),
        "recorded_cycles": ("stored_cycles", "recorded", "saved_cycles", "output_cycles"),
    },
    "shafts": {"torsional_stiffness": ("stiffness", "k", "c", "torsion", "spring_rate", "torsional_spring")},
    "bearings": {
        "stiffness": ("k", "c", "radial_stiffness", "spring_rate"),
        "stiffness_x": ("kx", "k_x"),
        "stiffness_y": ("ky", "k_y"),
    },
    "inertia": {
        "mass": ("m", "weight", "gear_mass"),
        "moment_of_inertia": (
            "j",
            "inertia",
            "theta",
            "mass_moment",
            "mass_moment_of_inertia",
            "rotational_inertia",
            "polar_moment",
        ),
    },
    "damping": {"stiffness_proportional": ("beta", "stiffness_factor"), "mass_proportional": ("alpha", "mass_factor")},
    "friction": {"coefficient": ("mu", "friction_coefficient", "coefficient_of_friction", "value")},
    "tip_relief": {
        "depth": ("amount", "ca", "c_a", "c_alpha_a", "height", "relief", "value", "magnitude"),
        "start": ("begin", "start_point", "start_diameter", "diameter", "d_ca", "start_angle", "roll_angle"),
        "length_on_path": ("length", "path_length", "length_of_path", "l_ca", "lca", "roll_length"),
        "length_on_flank": ("flank_length", "profile_length", "arc_length"),
        "shape": ("type", "form", "profile", "kind", "curve"),
    },
    "root_relief": {
        "depth": ("amount", "cf", "c_f", "c_alpha_f", "height", "relief", "value", "magnitude"),
        "start": ("begin", "start_point", "start_diameter", "diameter", "d_cf", "start_angle", "roll_angle"),
        "length_on_path": ("length", "path_length", "length_of_path", "l_cf", "lcf", "roll_length"),
        "length_on_flank": ("flank_length", "profile_length", "arc_length"),
        "shape": ("type", "form", "profile", "kind", "curve"),
    },
    "lead_modifications.pinion": {
        "crowning": ("c_beta", "cb", "lead_crowning", "helix_crowning", "width_crowning"),
        "helix_slope": ("c_hbeta", "chb", "slope", "helix_angle_modification", "lead_slope", "taper"),
        "end_relief": ("c_beta_i", "end_reliefs", "face_relief"),
    },
    "misalignment": {"in_plane": ("f_sigma_delta", "plane_of_action"), "out_of_plane": ("f_sigma_beta", "skew")},
    "flank_errors": {
        "tolerance_class": ("class", "quality", "grade", "accuracy_grade", "iso_1328"),
        "seed": ("random_seed",),
    },
    "flank_errors.pinion": {
        "file": ("table", "csv", "data", "measured"),
        "pitch": ("fp", "f_p", "fpt", "f_pt", "pitch_error", "pitch_errors", "single_pitch"),
        "profile_slope": ("fha", "f_ha", "fhalpha", "slope", "pressure_angle_error"),
        "profile_form": ("ffa", "f_fa", "ffalpha", "form"),
        "waviness": ("undulation", "waves", "ripple"),
    },
    "eccentricity.pinion": {
        "distance": ("amount", "eccentricity", "e", "offset", "runout", "run_out"),
        "phase": ("angle",),
    },
    "corner_contact": {"edge_radius": ("radius", "tip_radius", "rounding", "edge_rounding")},
    "speed_ramp": {
        "end_frequency": ("end", "stop", "final_frequency", "end_speed", "target_frequency"),
        "hold_cycles": ("hold", "wait", "start_cycles"),
    },
    "accuracy": {
        "flank_element_size": ("element_size", "mesh_size", "h", "size"),
        "contact_nodes": ("nodes", "n_contact"),
        "steps_per_mesh_cycle": ("steps", "time_steps", "n_steps"),
        "target": ("tolerance", "error", "rtol"),
        "element": ("element_type", "order", "degree"),
    },
}


def meant(section: Iterable[str], word: str, known: Iterable[str]) -> str | None:
    """The one of the known names of a section (its path) that engineers also call `word`; None where none is.

    >>> meant(["tip_relief", "pinion"], "amount", ["depth", "start"])
    'depth'
    """
    section, known, word = tuple(section), set(known), word.lower()
    homes = [section, *([section[:-1], (*section[:-1], "pinion")] if section[-1:] in (("pinion",), ("wheel",)) else [])]
    found = (
        name
        for home in homes
        for name, words in SYNONYMS.get(".".join(home), {}).items()
        if word in words and name in known
    )
    return next(found, None)
