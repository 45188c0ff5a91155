"""The attributes of a result: what each is, and when it is there. Tests compare the results of runs with this list.

What may be in a result beside them: one attribute for each method of the solver, by the prefix ``RUNG``, and one for each setting whose
error was estimated, by the prefix ``ESTIMATED``.
"""

from __future__ import annotations

from dataclasses import dataclass

RUNG = "steps_by_rung: "
ESTIMATED = "estimated_error: "


@dataclass(frozen=True)
class ResultAttribute:
    """One attribute: its name, its units ("" for a text or a switch), what it is, and ``when`` it is there ("" for always)."""

    name: str
    units: str
    meaning: str
    when: str = ""


OF_WHOLE_CYCLES = "a whole mesh cycle was run, at one speed"
WITH_TEETH = "the teeth are elastic"
WITH_CONTACT = "the teeth are elastic and contact is resolved over nodes"
WITH_PRESSURE = "the teeth are elastic, contact is resolved over nodes and some node carries"
WITH_STEPS = "a step was done"
WITH_FRICTION = "`[friction]`, and teeth that move and press"
AFTER_LOSS = "contact was lost"
ASKED_FOR = "`[output] root_stress`"
WITH_INERTIA = "`[inertia]`, and cycles that are alike or `[output] root_stress`"
WITH_ROOT_STRESS = "`[output] root_stress` with `[inertia]`"
WITH_TARGET = "`[accuracy] target`"
IN_STUDIES = "the run is a study's case"

RESULT_ATTRIBUTES = (
    ResultAttribute("title", "", "the scene's title"),
    ResultAttribute("scene", "", "the scene's whole text; saved as a file it runs again"),
    ResultAttribute("scene_name", "", "the name of the scene's file"),
    ResultAttribute("fenics_gears_version", "", "version of this program"),
    ResultAttribute("complete", "", "1 when the run reached its end, 0 when it failed or was interrupted before"),
    ResultAttribute("stopped", "", "why it is not complete: `interrupted` or `failed`", "`complete` is 0"),
    ResultAttribute("warnings", "", "what to be wary of, a line each"),
    ResultAttribute("settled_from", "s", "from when on steps are settled, the start having died down: all numbers are of these", WITH_STEPS),
    ResultAttribute("settled_cycles", "1", "mesh cycles from then to the end", WITH_STEPS),
    ResultAttribute("shown_cycles", "1", "mesh cycles, the last, that pictures show; all of a ramp"),
    ResultAttribute("mean_transmission_error", "rad", "mean over the settled steps, the last left out, which begins the next cycle"),
    ResultAttribute("peak_to_peak_transmission_error", "rad", "largest less smallest over the settled steps"),
    ResultAttribute("base_radius_wheel", "mm", "takes the transmission error to a length along the line of action"),
    *(
        ResultAttribute(f"transmission_error_harmonic_{n}", "um", f"amplitude of {words} mesh frequency in the transmission error, along the line of action", OF_WHOLE_CYCLES)
        for n, words in enumerate(("the", "twice the", "three times the", "four times the", "five times the"), 1)
    ),
    ResultAttribute("mean_mesh_stiffness", "N/(mm um)", "mesh stiffness c_gamma: mean of `mesh_stiffness` while the flanks touch, over the face width", WITH_TEETH),
    ResultAttribute("mean_mesh_stiffness_tangent", "N/(mm um)", "the same of `mesh_stiffness_tangent`, which small vibrations go by", WITH_TEETH),
    ResultAttribute("single_pair_stiffness", "N/(mm um)", "stiffness c' of a tooth pair: largest `mesh_stiffness` while one pair carries, over the face width", WITH_TEETH + " and one pair carries at times"),
    ResultAttribute("largest_pair_force", "N", "largest normal force of a tooth pair", "shares of the pairs are determined and some pair carries"),
    ResultAttribute("largest_pair_force_mesh_phase", "1", "mesh phase at which it is", "shares of the pairs are determined and some pair carries"),
    ResultAttribute("peak_contact_pressure", "MPa", "largest contact pressure, averaged over five contact nodes, off the flanks' edges: the largest `largest_contact_pressure`", WITH_CONTACT),
    ResultAttribute("peak_contact_pressure_time", "s", "time of the peak", WITH_PRESSURE),
    ResultAttribute("peak_contact_pressure_mesh_phase", "1", "mesh phase of the peak", WITH_PRESSURE),
    ResultAttribute("peak_contact_pressure_pair", "1", "tooth pair of the peak", WITH_PRESSURE),
    ResultAttribute("peak_contact_pressure_flank", "", "flanks of the peak: `drive` or `coast`", WITH_PRESSURE),
    ResultAttribute("peak_contact_pressure_diameter", "mm", "diameter of the pinion at the peak", WITH_PRESSURE),
    ResultAttribute("peak_edge_pressure", "MPa", "largest `largest_edge_pressure`; it does not converge with the mesh", "a pair presses with a tip's edge"),
    ResultAttribute("input_power", "W", "mean power of the gear that drives", "the drive does work"),
    ResultAttribute("friction_loss", "1", "share of the drive's work that is lost to friction between the flanks", WITH_FRICTION),
    ResultAttribute("friction_power", "W", "mean power lost to friction between the flanks", WITH_FRICTION),
    ResultAttribute("mesh_efficiency", "1", "1 less `friction_loss`: losses of bearings, oil and damping are not in it", WITH_FRICTION),
    ResultAttribute("contact_loss_count", "1", "how often the drive flanks lost contact, over the settled steps"),
    ResultAttribute("contact_loss_first", "s", "time of the first loss", AFTER_LOSS),
    ResultAttribute("contact_loss_longest", "s", "how long the longest lasted", AFTER_LOSS),
    ResultAttribute("contact_loss_share", "1", "share of the settled time without contact", AFTER_LOSS),
    ResultAttribute("contact_loss_opening", "mm", "widest opening between the drive flanks", AFTER_LOSS),
    ResultAttribute("dynamic_factor_by_force", "1", "dynamic factor: largest force of a tooth pair over that of the quasi-static run", WITH_INERTIA),
    ResultAttribute("dynamic_factor_by_stress", "1", "the same by root stress", WITH_ROOT_STRESS),
    ResultAttribute("quasi_static_pair_normal_force", "N", "largest force of a tooth pair in the quasi-static run", WITH_INERTIA),
    ResultAttribute("quasi_static_root_stress", "MPa", "largest root stress in the quasi-static run", WITH_ROOT_STRESS),
    ResultAttribute("dynamic_factor_unknown", "", "why there are none of these four, in their place", "`[inertia]`"),
    *(
        attribute
        for gear in ("pinion", "wheel")
        for attribute in (
            ResultAttribute(f"largest_root_stress_{gear}", "MPa", f"largest tension in the {gear}'s fillets", ASKED_FOR),
            ResultAttribute(f"largest_root_stress_{gear}_mesh_phase", "1", "mesh phase at which it is", ASKED_FOR),
            ResultAttribute(f"largest_root_stress_{gear}_pair", "1", "tooth pair to which its tooth belongs", ASKED_FOR),
            ResultAttribute(f"largest_root_stress_{gear}_fillet", "", "side of the tooth that it is on: `drive` or `coast`", ASKED_FOR),
        )
    ),
    ResultAttribute("element", "", "finite element that was used"),
    ResultAttribute("flank_element_size", "mm", "size of the flank's elements that was used"),
    ResultAttribute("contact_length", "mm", "contact length of a tooth pair that was used"),
    ResultAttribute("contact_nodes", "1", "contact nodes of a tooth pair that were used"),
    ResultAttribute("steps_per_mesh_cycle", "1", "time steps of a mesh cycle that were used"),
    ResultAttribute("condensation", "", "how often the gears were condensed"),
    ResultAttribute("model", "", "what the mesh was computed as"),
    ResultAttribute("target", "1", "the error asked for, in parts of 1", WITH_TARGET),
    ResultAttribute("estimated_error", "1", "estimated error of the transmission error's curve and of its height, the larger, in parts of 1", WITH_TARGET),
    ResultAttribute("target_runs", "1", "runs by which the settings were chosen", WITH_TARGET),
    ResultAttribute("target_remarks", "", "settings with much of the error that does not fall with the order expected, and what else to know, a line each", WITH_TARGET),
    ResultAttribute("steps", "1", "time steps of the whole run"),
    ResultAttribute("newton_iterations_total", "1", "Newton iterations of the whole run"),
    ResultAttribute("time_choose", "s", "wall time of choosing settings", WITH_TARGET),
    ResultAttribute("time_mesh", "s", "wall time of meshing; 0 for gears from the cache"),
    ResultAttribute("time_condense", "s", "wall time of assembling and condensing"),
    ResultAttribute("time_compile", "s", "wall time of compiling"),
    ResultAttribute("time_march", "s", "wall time of the march through time"),
    ResultAttribute("wall_time", "s", "wall time of the case", IN_STUDIES),
    ResultAttribute("case_key", "", "hash of all that the case's result depends on", IN_STUDIES),
    ResultAttribute("case_values", "", "the swept values, as JSON", IN_STUDIES),
)
