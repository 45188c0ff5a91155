"""Undercut and protuberance against a simulation of the cutting."""

from dataclasses import replace
from math import cos, pi, radians, tan

import numpy as np
import pytest

from fenics_gears.geometry.outline import tooth_outline

MICROMETRE = 1e-3
PROTUBERANCES = {
    "usual hob before grinding": (dict(teeth=25), 0.02, 10.0),
    "much, with a steep flank": (dict(teeth=40, rack_tip=0.25), 0.06, 5.0),
    "little, within the rounding": (dict(teeth=60), 0.003, 10.0),
    "with undercut": (dict(teeth=13), 0.03, 10.0),
    "with profile shift, 25 deg": (dict(teeth=20, profile_shift=0.4, pressure_angle=25.0, rack_tip=0.25), 0.03, 12.0),
    "helix of 25 deg": (dict(teeth=22, helix_angle=25.0), 0.025, 8.0),
}
MODULE = 5.0


def rack_profile(gear):
    """Half thickness and depth (n, 2), mm, of the rack's tooth in the transverse section, from the drawing of the
    tool in its normal section."""
    alpha, rounding, module = gear.normal_pressure_angle, gear.rack_tip_radius, gear.normal_module
    beta, protuberance = gear.helix_angle, gear.protuberance
    steep = gear.protuberance_angle if protuberance else alpha
    shift, depth = gear.profile_shift * gear.module, gear.reference_radius - gear.root_radius

    def flank(at):
        return 0.25 * pi * module - (at + shift) * tan(alpha)

    # The rounding's tangent at the pressure angle stands out of the flank by the protuberance.
    centre = flank(depth - rounding) - rounding / cos(alpha) + protuberance / cos(alpha)
    angle = np.linspace(0.0, 0.5 * pi - steep, 4001)
    arc = np.column_stack([centre + rounding * np.sin(angle), depth - rounding + rounding * np.cos(angle)])
    if protuberance:
        arc = arc[: np.flatnonzero(arc[:, 0] >= flank(arc[:, 1]))[-1] + 1]
    x, at = arc[-1]
    goes_back = (x - flank(at)) / (tan(alpha) - tan(steep)) if steep < alpha else 0.0
    top = at - max(goes_back, 0.0)
    points = np.vstack([[0.0, depth], arc, [flank(top), top], [flank(-2.0 * module), -2.0 * module]])
    return points * [1.0 / cos(beta), 1.0]


def deepest_cut(gear, points):
    """How far (n,), mm along the pitch line, the rack goes over points (n, 2) of the tooth's body frame; negative
    where it leaves them."""
    (half, depth), r, z = rack_profile(gear)[::-1].T, gear.reference_radius, gear.teeth
    half_tooth = (
        (0.5 * pi + 2.0 * gear.profile_shift * tan(gear.pressure_angle)) / z
        + tan(gear.pressure_angle)
        - gear.pressure_angle
    )
    width, centre = 2.5 * pi / z + 0.6, np.zeros((len(points), 1))
    for _ in range(4):
        rotation = centre + width * np.linspace(-1.0, 1.0, 1201)
        pose = rotation - pi / z + half_tooth
        x = np.cos(pose) * points[:, :1] - np.sin(pose) * points[:, 1:] - r * rotation
        at = np.sin(pose) * points[:, :1] + np.cos(pose) * points[:, 1:] + r
        cut = np.where(at < depth[-1], np.interp(at, depth, half) - np.abs(x), -np.inf)
        most = np.argmax(cut, axis=1)[:, None]
        centre, width = np.take_along_axis(rotation, most, axis=1), 0.01 * width
    return np.take_along_axis(cut, most, axis=1)[:, 0]


def drive_side(gear):
    """Points (n, 2), mm, along fillet and involute, without their edge, and outward normals."""
    outline = tooth_outline(gear, 1201)
    involute = outline.involute(np.sqrt(np.linspace(gear.form_roll_angle**2, gear.tip_roll_angle**2, 1201)))
    points, normals = [], []
    for curve in (outline.fillet, involute):
        tangent = np.gradient(curve, axis=0)[20:-20:20]
        points.append(curve[20:-20:20])
        normals.append(np.column_stack([-tangent[:, 1], tangent[:, 0]]) / np.linalg.norm(tangent, axis=1)[:, None])
    points, normals = np.vstack(points), np.vstack(normals)
    return points, -normals if normals[-1][0] < 0.0 else normals


def check(gear):
    points, out = drive_side(gear)
    assert np.all(deepest_cut(gear, points - MICROMETRE * out) < 0.0)
    assert np.all(deepest_cut(gear, points + MICROMETRE * out) > 0.0)
    # The edge between fillet and involute is on both.
    edge = tooth_outline(gear).fillet[-1]
    assert deepest_cut(gear, edge[None])[0] == pytest.approx(0.0, abs=MICROMETRE)


@pytest.mark.parametrize("name", PROTUBERANCES)
def test_a_tooth_cut_with_protuberance_is_what_the_rolling_rack_leaves(cut_gear, name):
    """The simulation; the finished flank is cut by the rack's straight flank."""
    cut, protuberance, angle = PROTUBERANCES[name]
    gear = replace(
        cut_gear(**cut, module=MODULE), protuberance=protuberance * MODULE, protuberance_angle=radians(angle)
    )
    plain = replace(gear, protuberance=0.0)
    assert gear.undercut and gear.form_radius > plain.form_radius
    check(gear)
