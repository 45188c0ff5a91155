"""The paper's ten claims (model.md, section 6), each measured against a criterion in numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from demos.lundvall2004 import spectrum
from demos.lundvall2004.measured import WITH, WITHOUT, base_pair, base_scene, one_cycle, peak_to_peak

HELD, IN_PART, NOT_HELD = "held", "in part", "not held"
MICRO = 1e6
HAND_OVER = 0.02  # mesh cycles: the time in which a change is called sudden
WELL_ABOVE = 1.5  # times the highest natural frequency


@dataclass(frozen=True)
class Claim:
    """A claim of the paper and what was measured: verdict HELD, IN_PART or NOT_HELD; `why` where it is not held as a
    whole."""

    number: str
    statement: str
    where: str
    criterion: str
    measured: str
    verdict: str
    why: str = ""


def verdict(*parts: bool) -> str:
    """HELD when all parts hold, NOT_HELD when none does."""
    return HELD if all(parts) else IN_PART if any(parts) else NOT_HELD


def claim_1(static: xr.Dataset) -> Claim:
    """No motion off the line of action without friction; `static`: study figure02."""
    still, moved = (float(np.abs(static.centre_y.sel(friction=f)).max()) * 1e3 for f in (WITHOUT, WITH))
    return Claim(
        "1", "without friction there is no off-line-of-action motion at all", "Fig. 2",
        "largest displacement of either gear off the line of action is 0",
        f"{still:g} um without friction; {moved:.2f} um with", verdict(still == 0.0),
    )  # fmt: skip


def claim_2(static: xr.Dataset) -> Claim:
    """d_y2 over the mesh cycle; `static`: study figure02."""
    scene, pair = base_scene(), base_pair()
    pitch = (pair.pitch_point - pair.path_start) / pair.base_pitch
    displacement = one_cycle(static, "centre_y", WITH)
    full = scene.friction.coefficient * one_cycle(static, "normal_force", WITH) / scene.bearings.stiffness
    phase = static.mesh_phase.values[: len(displacement)]
    share = displacement / full
    begin = np.abs(share[phase < 0.4]).max()
    before, after = share[(phase > 0.56) & (phase < pitch - 0.01)], share[(phase > pitch + 0.12) & (phase < 0.93)]
    change = phase[(phase > pitch - 0.02) & (phase < 0.93) & (np.abs(share) < 0.99)]
    return Claim(
        "2",
        "with friction d_y2 is about zero at the beginning of a mesh cycle and jumps from one sign to the other at "
        "the pitch point",
        "Figs. 2, 3",
        "below 20 % of mu F/k_b while phase < 0.4; -mu F/k_b before the pitch point and +mu F/k_b after it, within 1 %",
        f"at most {begin:.0%} of mu F/k_b at the beginning; {before.mean():.3f} mu F/k_b before the pitch point "
        f"(phase {pitch:.3f}), {after.mean():+.3f} after it; "
        f"the sign changes while the flanks stick, phases {change.min():.3f} to {change.max():.3f}",
        verdict(begin < 0.2 and np.all(np.abs(before + 1) < 0.01) and np.all(np.abs(after - 1) < 0.01)),
    )  # fmt: skip


def claim_3(static: xr.Dataset) -> Claim:
    """The fall of the static transmission error at the pitch point; `static`: study figure02."""
    pair = base_pair()
    pitch = (pair.pitch_point - pair.path_start) / pair.base_pitch
    fall = {}
    for friction in (WITH, WITHOUT):
        error = one_cycle(static, "transmission_error", friction)
        phase = static.mesh_phase.values[: len(error)]
        fall[friction] = np.ptp(error[(phase > pitch - 0.01) & (phase < pitch + 0.12)])
    scale = float(static.peak_to_peak_transmission_error.sel(friction=WITHOUT))
    return Claim(
        "3", "with friction the static transmission error changes suddenly at the end of the mesh cycle", "Fig. 2",
        "change round the pitch point above 50 % of the frictionless T_EPP with friction, below 5 % without",
        f"{fall[WITH] * MICRO:.0f} urad ({fall[WITH] / scale:.0%}) with friction, {fall[WITHOUT] * MICRO:.1f} urad "
        f"({fall[WITHOUT] / scale:.1%}) without",
        verdict(fall[WITH] > 0.5 * scale and fall[WITHOUT] < 0.05 * scale),
    )  # fmt: skip


def claim_4(friction: xr.Dataset, plain: xr.Dataset) -> Claim:
    """Variation of the reactions; `friction`, `plain`: runs of study figure04."""

    def spread(run: xr.Dataset, name: str, gear: str = "pinion") -> float:
        values = run[name].sel(gear=gear).values
        return float(np.ptp(values) / np.abs(run.normal_force if name == "reaction_y" else values).mean())

    names = {"reaction_x": "R_x1", "reaction_y": "R_y1", "reaction_couple": "C_z1"}
    varies, constant = {n: spread(friction, n) for n in names}, {n: spread(plain, n) for n in names}
    output = spread(friction, "reaction_couple", "wheel")
    listed = ", ".join(f"{names[n]} {varies[n]:.1%}" for n in names)
    return Claim(
        "4",
        "friction makes the reactions R_x1, R_y1 and the input torque C_z1 vary though the output torque is constant",
        "Fig. 4",
        "peak to peak (of the mean; R_y1 of the normal force) above 3 % with friction, below 1e-9 without; output "
        "torque constant to 1e-9",
        f"{listed} with friction; at most {max(constant.values()):.0e} without; output torque {output:.0e}",
        verdict(min(varies.values()) > 0.03 and max(constant.values()) < 1e-9 and output < 1e-9),
    )  # fmt: skip


def claim_5(static: xr.Dataset, dynamic: xr.Dataset) -> Claim:
    """Shapes and lags at 200 Hz; `static`: study figure02, `dynamic`: study figure05."""
    likeness, lag = spectrum.lag(*(one_cycle(dynamic, "transmission_error", f) for f in (WITHOUT, WITH)))
    _, lag_before = spectrum.lag(*(one_cycle(static, "transmission_error", f) for f in (WITHOUT, WITH)))
    steps = len(one_cycle(dynamic, "centre_y", WITH))

    def likeness_to_static(variable: str, friction: str) -> float:
        still = one_cycle(static, variable, friction)
        still = np.interp(np.arange(steps) / steps, np.arange(len(still)) / len(still), still, period=1.0)
        return spectrum.lag(one_cycle(dynamic, variable, friction), still)[0]

    sideways = likeness_to_static("centre_y", WITH)
    to_static = [likeness_to_static("transmission_error", friction) for friction in (WITH, WITHOUT)]
    alike, behind, reminds = likeness > 0.98, lag > max(0.02, lag_before), sideways > 0.95
    return Claim(
        "5", "at 200 Hz the curves keep their shape, the frictionless one lagging behind", "Fig. 5",
        "T_E with and without friction correlate above 0.98 after a shift in time. The frictionless one lags by more "
        "than 0.02 cycles and more than "
        "in the static case. d_y2 correlates above 0.95 with its static curve",
        f"correlation {likeness:.3f}, lag {lag:.3f} cycles (static {lag_before:.3f}); d_y2 {sideways:.3f}; "
        f"with its static curve T_E correlates {to_static[0]:.2f} with friction, {to_static[1]:.2f} without",
        verdict(alike, behind, reminds),
        "" if alike and behind else "the mesh frequency is far below the torsional modes: the curves are the static "
        "ones, which differ only by friction",
    )  # fmt: skip


def claim_6a(curve: xr.Dataset, where: str = "Fig. 6", number: str = "6a", pair: str = "") -> Claim:
    """Friction raises T_EPP at every mesh frequency."""
    raised = peak_to_peak(curve, WITH) - peak_to_peak(curve, WITHOUT)
    frequency, above = curve.mesh_frequency.values, raised > 0.0
    text = (
        f"friction raises it at {above.sum()} of {len(above)} frequencies; the change is {raised.min() * MICRO:+.1f} to"
        f" {raised.max() * MICRO:+.0f} urad"
    )
    if not above.all():
        lowest = int(raised.argmin())
        text += (
            f". Friction lowers it between {frequency[~above].min():.0f} and {frequency[~above].max():.0f} Hz, most at"
            f" {frequency[lowest]:.0f} Hz: {peak_to_peak(curve, WITH)[lowest] * MICRO:.1f} against"
            f" {peak_to_peak(curve, WITHOUT)[lowest] * MICRO:.1f} urad"
        )
    return Claim(
        number, f"friction always raises T_EPP{pair}", where, "raised at every swept mesh frequency", text,
        verdict(bool(above.all()), bool(above.any())),
    )  # fmt: skip


def claim_6b(curve: xr.Dataset, static: xr.Dataset, highest: float) -> Claim:
    """T_EPP below the static value well above the natural frequencies; `highest`: natural frequency, Hz; `static`:
    study figure02."""
    frequency = curve.mesh_frequency.values
    still = {f: float(static.peak_to_peak_transmission_error.sel(friction=f)) for f in (WITH, WITHOUT)}
    below = np.all([peak_to_peak(curve, f) < still[f] for f in still], axis=0)
    far = frequency > WELL_ABOVE * highest
    crossing = frequency[~below].max(initial=0.0)
    if not far.any():
        raise ValueError(f"no frequency swept lies above {WELL_ABOVE * highest:.0f} Hz")
    share = [peak_to_peak(curve, f)[far].max() / still[f] for f in still]
    return Claim(
        "6b", "well above the natural frequencies T_EPP is below the static value", "Figs. 2, 6",
        f"below it at every frequency over {WELL_ABOVE} times the highest natural frequency, with friction and without",
        f"highest natural frequency {highest:.0f} Hz; above {WELL_ABOVE * highest:.0f} Hz at most {max(share):.0%} of "
        f"the static value; below it at every frequency swept above {crossing:.0f} Hz",
        verdict(bool(below[far].all())),
    )  # fmt: skip


def claim_7(unmodified: xr.Dataset, modified: xr.Dataset) -> Claim:
    """Friction force at hand-over; runs with friction of studies figure04 and figure08."""
    before, after = sudden_change(unmodified), sudden_change(modified)
    return Claim(
        "7", "the friction force of the modified pair (31 um) passes smoothly between pairs", "Fig. 8",
        f"R_y1 changes by less than 15 % of mu T2/rb2 in any {HAND_OVER} mesh cycles away from the pitch point",
        f"{after:.1%}; the unmodified pair {before:.1%}", verdict(after < 0.15),
    )  # fmt: skip


def sudden_change(run: xr.Dataset) -> float:
    """Largest change of the pinion's reaction off the line of action within HAND_OVER mesh cycles, as a share of mu
    T2/rb2.

    The passage of the pitch point, where friction changes its sign, is left out: a tenth of a cycle, as the flanks
    stick.
    """
    scene, pair = base_scene(), base_pair()
    window = round(HAND_OVER * run.attrs["steps_per_mesh_cycle"])
    force, phase = run.reaction_y.sel(gear="pinion").values, run.mesh_phase.values[:-window] % 1.0
    pitch = (pair.pitch_point - pair.path_start) / pair.base_pitch
    away = (phase < pitch - 2 * HAND_OVER) | (phase > pitch + 0.12)
    change = np.abs(force[window:] - force[:-window])[away].max()
    return float(change / (scene.friction.coefficient * scene.load.wheel_torque / pair.wheel.base_radius))


def claim_8(static: xr.Dataset, dynamic: xr.Dataset) -> Claim:
    """The best depth of the relief; studies figure09_static and figure09_dynamic."""
    best = {f: best_depth(dynamic, f) for f in (WITH, WITHOUT)}
    still, apart = best_depth(static, WITHOUT), abs(best[WITH] - best[WITHOUT])
    return Claim(
        "8",
        "T_EPP against relief depth has its optimum near 30 um; the optimum differs with and without friction, by "
        "little",
        "Fig. 9",
        "all three optima in 30 +- 5 um; those at 200 Hz differ, by no more than 5 um",
        f"static {still:.0f} um; 200 Hz {best[WITHOUT]:.0f} um without friction, {best[WITH]:.0f} um with (depths 1 "
        f"um apart)",
        verdict(all(25.0 <= depth <= 35.0 for depth in (still, *best.values())) and 0.0 < apart <= 5.0),
    )  # fmt: skip


def best_depth(curve: xr.Dataset, friction: str) -> float:
    """Depth of the relief (um) with the least T_EPP among those swept."""
    return float(curve.depth.values[peak_to_peak(curve, friction).argmin()])


def claim_9(unmodified: xr.Dataset, modified: xr.Dataset, static: xr.Dataset) -> Claim:
    """What 31 um gain, with friction and without; Figs. 6 and 10 and study figure09_static."""
    unmodified = unmodified.sel(mesh_frequency=modified.mesh_frequency)
    gain = {f: 1.0 - peak_to_peak(modified, f) / peak_to_peak(unmodified, f) for f in (WITH, WITHOUT)}
    still = {
        f: 1.0 - peak_to_peak(static.sel(depth=31.0), f) / peak_to_peak(static.isel(depth=0), f)
        for f in (WITH, WITHOUT)
    }
    peaks = {f: 1.0 - peak_to_peak(modified, f).max() / peak_to_peak(unmodified, f).max() for f in (WITH, WITHOUT)}
    less, frequency = gain[WITH] < gain[WITHOUT], modified.mesh_frequency.values
    text = (
        f"T_EPP falls by {still[WITH]:.0%} with friction, {still[WITHOUT]:.0%} without (static); its largest value over"
        f" all frequencies by {peaks[WITH]:.0%} and {peaks[WITHOUT]:.0%}; less with friction at {less.sum()} of"
        f" {len(less)} frequencies"
    )
    if not less.all():
        text += f", more from {frequency[~less].min():.0f} to {frequency[~less].max():.0f} Hz"
    return Claim(
        "9", "relief gains less when friction acts", "Figs. 6, 9, 10",
        "the relative reduction of T_EPP by 31 um is smaller with friction: static, at the largest value, at every "
        "frequency",
        text, verdict(still[WITH] < still[WITHOUT], peaks[WITH] < peaks[WITHOUT], bool(less.all())),
        "" if less.all() else "friction adds little to T_EPP of the modified pair there, or lowers it, see 6c",
    )  # fmt: skip


def claim_10(undamped: xr.Dataset, damped: xr.Dataset) -> Claim:
    """Contact without damping; study undamped and Fig. 6."""

    def warned(study: xr.Dataset, words: str) -> np.ndarray:
        return np.array([[words in text for text in row] for row in study.warnings.values])

    lost, beyond = (warned(undamped, words).any(axis=1) for words in ("lose contact", "coast flanks would touch"))
    frequency = undamped.mesh_frequency.values
    with_damping = int(warned(damped, "lose contact").sum())
    text = (
        f"undamped contact is lost at {', '.join(f'{f:.0f}' for f in frequency[lost])} Hz of {len(frequency)} mesh"
        " frequencies"
    )
    if beyond.any():
        text += f", at {', '.join(f'{f:.0f}' for f in frequency[beyond])} Hz by more than the backlash"
    return Claim(
        "10", "without damping contact is lost globally", "Section 5",
        "teeth separate by more than the backlash somewhere without damping, nowhere with it",
        f"{text}; with damping in {with_damping} of {damped.warnings.size} runs",
        verdict(bool(beyond.any()) and not with_damping),
    )  # fmt: skip
