"""Brute force on outlines: dense points, turned and moved until they touch."""

import numpy as np
from scipy.spatial import cKDTree

from fenics_gears.geometry.involute import arc_length, canonical_point, roll_angle_at_arc_length


def turned(points, angle):
    sine, cosine = np.sin(angle), np.cos(angle)
    return np.asarray(points) @ np.array([[cosine, sine], [-sine, cosine]])


def outline(gear, edge, count):
    """Drive flank from the form circle, then the tip edge (n, 2), mm, in the tooth's body frame; its radius rises."""
    ends = arc_length(gear.base_radius, np.array([gear.form_roll_angle, edge.flank_roll]))
    flank = canonical_point(gear.base_radius, roll_angle_at_arc_length(gear.base_radius, np.linspace(*ends, count)))
    return np.vstack([flank, edge.points(np.linspace(0.0, 1.0, count))[1:]]) if edge.radius else flank


def centres(pair):
    """Centres (2, 2), mm; the line of action is the x axis, its tangent point on the pinion the origin."""
    return np.array([[0.0, pair.pinion.base_radius], [pair.line_of_action_length, -pair.wheel.base_radius]])


def placed(pair, edges, place, count=20001, moved=np.zeros((2, 3))):
    """Outlines of pinion and wheel at a theoretical place, each then moved by (x, y, rotation) (2, 3), mm and rad."""
    poses = (place.contact_rolls[0], np.pi + place.contact_rolls[1])
    return tuple(
        centre + move[:2] + turned(outline(gear, edge, count), pose + move[2])
        for gear, edge, centre, pose, move in zip((pair.pinion, pair.wheel), edges, centres(pair), poses, moved)
    )


def rotation_to_touch(moving, other, centre):
    """Counter-clockwise rotation (rad) of a curve about `centre` until it touches another."""
    (radius, angle), (other_radius, other_angle) = (
        (np.linalg.norm(curve - centre, axis=1), np.arctan2(*(curve - centre).T[::-1])) for curve in (moving, other)
    )
    shared = (other_radius >= radius[0]) & (other_radius <= radius[-1])
    ahead = other_angle[shared] - np.interp(other_radius[shared], radius, np.unwrap(angle))
    return np.min(np.remainder(ahead + np.pi, 2.0 * np.pi) - np.pi)


def distance(curves):
    """Least distance (mm) between two polylines, looked for around where every 50th points are nearest."""
    sparse = [curve[::50] for curve in curves]
    apart, nearest = cKDTree(sparse[1]).query(sparse[0])
    middles = sparse[0][apart.argmin()], sparse[1][nearest[apart.argmin()]]
    curves = [curve[np.linalg.norm(curve - middle, axis=1) < 0.2] for curve, middle in zip(curves, middles)]
    least = np.inf
    for points, line in (curves, curves[::-1]):
        start, step = line[:-1], np.diff(line, axis=0)
        near = cKDTree(0.5 * (line[1:] + line[:-1])).query(points, k=3)[1]
        for segment in near.T:
            share = np.sum((points - start[segment]) * step[segment], axis=1) / np.sum(step[segment] ** 2, axis=1)
            foot = start[segment] + np.clip(share, 0.0, 1.0)[:, None] * step[segment]
            least = min(least, np.linalg.norm(points - foot, axis=1).min())
    return least
