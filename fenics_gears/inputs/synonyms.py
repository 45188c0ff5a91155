"""Symbols and other words that engineers use for sections and fields: looked up only for an unknown name, to suggest
the right one.

Only what no likeness of spelling finds: the standards' symbols, and the commonest other word.
"""

from __future__ import annotations

from collections.abc import Iterable

# A gear's own section also has the names of the section above.
SYNONYMS = {
    "gears": "pair stage geometry",
    "load": "torque",
    "motion": "speed kinematics operation",
    "accuracy": "mesh numerics solver resolution",
    "output": "results",
    "inertia": "mass dynamics",
    "shafts": "torsion coupling",
    "bearings": "supports",
    "friction": "mu coulomb lubrication",
    "tip_relief": "relief profile_modification modifications ca",
    "root_relief": "cf foot_relief",
    "lead_modifications": "lead crowning flank_line_modifications helix_modifications",
    "misalignment": "axis_deviation parallelism skew",
    "flank_errors": "errors deviations tolerances",
    "eccentricity": "runout run_out",
    "coast_flanks": "backlash back_flanks",
    "corner_contact": "tip_contact premature_contact edge_radius",
    "torque_ripple": "torque_fluctuation",
    "speed_ramp": "run_up coast_down",
    "body_meshes": "meshes cracks crack",
    "gears.module": "m mn m_n",
    "gears.pressure_angle": "alpha alpha_n",
    "gears.centre_distance": "a aw a_w axis_distance",
    "gears.face_width": "b width",
    "gears.material": "steel",
    "gears.backlash": "jt j_t jwt j_wt jn j_bn play",
    "gears.tip_shortening": "k topping",
    "gears.helix_angle": "beta spiral_angle",
    "gears.pinion": "gear1 driver",
    "gears.wheel": "gear2 driven gear",
    "gears.pinion.teeth": "z",
    "gears.pinion.profile_shift": "x addendum_modification",
    "gears.pinion.tip_diameter": "da d_a outside_diameter",
    "gears.pinion.root_diameter": "df d_f",
    "gears.pinion.bore_diameter": "di hub_diameter shaft_diameter",
    "gears.pinion.rack_tip_radius": "rho_fp fillet_radius root_radius cutter_radius",
    "gears.pinion.tooth_thickness": "s sn s_n",
    "gears.pinion.base_tangent_length": "w wk w_k span",
    "gears.pinion.spanned_teeth": "k",
    "gears.pinion.dimension_over_balls": "md m_d mdk m_dk over_pins",
    "gears.pinion.ball_diameter": "dm d_m pin_diameter",
    "gears.pinion.rack": "tool hob basic_rack reference_profile",
    "gears.rack.addendum": "hap h_ap",
    "gears.rack.dedendum": "hfp h_fp",
    "gears.rack.tip_radius": "rho_fp fillet_radius",
    "gears.material.youngs_modulus": "e modulus",
    "gears.material.poissons_ratio": "nu mu",
    "gears.material.yield_strength": "re rp02",
    "load.wheel_torque": "torque t2 moment",
    "load.pinion_torque": "t1 input_torque",
    "load.power": "p kw",
    "motion.mesh_frequency": "f fz",
    "motion.pinion_speed": "speed n n1 rpm omega",
    "motion.mesh_cycles": "duration periods",
    "motion.settling_time": "transient_time",
    "motion.recorded_cycles": "output_cycles",
    "shafts.torsional_stiffness": "k c spring_rate",
    "bearings.stiffness": "k c spring_rate",
    "inertia.mass": "m weight",
    "inertia.moment_of_inertia": "j inertia mass_moment",
    "damping.stiffness_proportional": "beta",
    "damping.mass_proportional": "alpha",
    "friction.coefficient": "mu",
    "tip_relief.depth": "amount ca c_alpha_a height",
    "tip_relief.start": "begin diameter d_ca",
    "tip_relief.length_on_path": "length l_ca lca roll_length",
    "tip_relief.shape": "type form profile curve",
    "root_relief.depth": "amount cf c_alpha_f height",
    "root_relief.start": "begin diameter d_cf",
    "root_relief.length_on_path": "length l_cf lcf roll_length",
    "root_relief.shape": "type form profile curve",
    "lead_modifications.pinion.crowning": "c_beta cb",
    "lead_modifications.pinion.helix_slope": "c_hbeta chb taper",
    "misalignment.in_plane": "f_sigma_delta",
    "misalignment.out_of_plane": "f_sigma_beta skew",
    "flank_errors.tolerance_class": "quality grade iso_1328",
    "flank_errors.pinion.file": "table csv measured",
    "flank_errors.pinion.pitch": "fp f_p fpt f_pt",
    "flank_errors.pinion.profile_slope": "fha f_ha fhalpha",
    "flank_errors.pinion.profile_form": "ffa f_fa ffalpha",
    "flank_errors.pinion.waviness": "undulation ripple",
    "eccentricity.pinion.distance": "amount e offset runout run_out",
    "corner_contact.edge_radius": "rounding",
    "speed_ramp.end_frequency": "stop target_frequency",
    "speed_ramp.hold_cycles": "wait",
    "accuracy.flank_element_size": "mesh_size h",
    "accuracy.contact_nodes": "n_contact",
    "accuracy.steps_per_mesh_cycle": "n_steps",
    "accuracy.target": "tolerance error rtol",
    "accuracy.element": "order degree",
}


def meant(section: Iterable[str], word: str, known: Iterable[str]) -> str | None:
    """The one of the known names of a section (its path) that engineers also call `word`; None where none is.

    >>> meant(["tip_relief", "pinion"], "amount", ["depth", "start"])
    'depth'
    """
    section, known = tuple(section), tuple(known)
    homes = [section, *([section[:-1], (*section[:-1], "pinion")] if section[-1:] in (("pinion",), ("wheel",)) else [])]
    found = (
        name for home in homes for name in known if word.lower() in SYNONYMS.get(".".join((*home, name)), "").split()
    )
    return next(found, None)
