"""A gear pair as GetFEM has it, two bodies in the integral large-sliding contact with ray tracing of K. Poulios, Y.
Renard, Computers & Structures 153, 2015, without friction: for each position the wheel's rotation (rad) under the
torque, the torques on both bores and seconds; JSON in, JSON out. N, mm, rad, per mm of face width."""

import json
import sys
import time

import getfem as gf
import numpy as np

SLAVE, MASTER, HUB = 1, 2, 3
# GT_PK(2,2) numbers the nodes of a triangle row by row.
ORDER = [0, 3, 1, 5, 4, 2]
MIDDLES = [3, 4, 5]
# Of the torque; the rotation is that close too.
CLOSE_ENOUGH = 1e-4


def body(points, cells, contact, hub, region):
    """Mesh with its regions, displacement space and quadrature."""
    mesh = gf.Mesh("empty", 2)
    for cell in cells:
        mesh.add_convex(gf.GeoTrans("GT_PK(2,2)"), points[cell[ORDER]].T)
    faces = mesh.outer_faces()
    middles = np.array([points_on(mesh, face) for face in faces.T])
    touching = points[[cells[cell][MIDDLES[side]] for cell, side in contact]]
    mesh.set_region(region, faces[:, near(middles, touching)])
    mesh.set_region(HUB, faces[:, near(middles, points[hub])])
    space = gf.MeshFem(mesh, 2)
    space.set_fem(gf.Fem("FEM_PK(2,2)"))
    return mesh, space, gf.MeshIm(mesh, gf.Integ("IM_TRIANGLE(6)"))


def points_on(mesh, face):
    nodes = mesh.pts(mesh.pid_in_faces(face.reshape(2, 1)))
    ends = nodes.mean(axis=1)
    return nodes[:, np.argmin(np.linalg.norm(nodes - ends[:, None], axis=0))]


def near(points, others):
    """Which points (n, 2) are among others (k, 2)."""
    known = {tuple(np.round(each, 9)) for each in others}
    return np.array([tuple(np.round(each, 9)) in known for each in points])


def pair(given, position):
    """The model at a position: what turns the wheel's bore and gives the torques on both bores (N mm per mm), and
    unknowns."""
    young, poisson = given["youngs_modulus"], given["poissons_ratio"]
    lame, shear = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))
    model = gf.Model("real")
    model.add_initialized_data("lame", [lame])
    model.add_initialized_data("shear", [shear])
    model.add_initialized_data("augmentation", [young])
    bodies = []
    for number, region in ((0, SLAVE), (1, MASTER)):
        points, shape = np.array(position["points"][number]), given["meshes"][number]
        mesh, space, quadrature = body(points, np.array(shape["cells"]), shape["contact"], shape["hub"], region)
        name = f"u{number}"
        model.add_fem_variable(name, space)
        model.add_isotropic_linearized_elasticity_brick(quadrature, name, "lame", "shear")
        model.add_initialized_fem_data(f"turned{number}", space, np.zeros(space.nbdof()))
        model.add_Dirichlet_condition_with_simplification(name, HUB, f"turned{number}")
        bodies.append((mesh, space, quadrature))
    multipliers = gf.MeshFem(bodies[0][0], 2)
    multipliers.set_fem(gf.Fem("FEM_PK(2,1)"))
    model.add_filtered_fem_variable("pressure", multipliers, SLAVE)
    contact = model.set("add_integral_large_sliding_contact_brick_raytracing", "augmentation", given["release"])
    model.set(
        "add_slave_contact_boundary_to_large_sliding_contact_brick", contact, bodies[0][2], SLAVE, "u0", "pressure"
    )
    model.set("add_master_contact_boundary_to_large_sliding_contact_brick", contact, bodies[1][2], MASTER, "u1")
    stiffness = []
    for mesh, space, quadrature in bodies:
        data = gf.MeshFem(mesh, 1)
        data.set_classical_fem(0)
        stiffness.append(
            gf.asm_linear_elasticity(quadrature, space, data, np.full(data.nbdof(), lame), np.full(data.nbdof(), shear))
        )
    hubs = [space.basic_dof_on_region(HUB) for _, space, _ in bodies]
    arms = [
        space.basic_dof_nodes()[:, ::2] - np.array(centre)[:, None]
        for (_, space, _), centre in zip(bodies, given["centres"])
    ]

    def turn(angle):
        cosine, sine = np.cos(angle) - 1.0, np.sin(angle)
        moved = np.stack([cosine * arms[1][0] - sine * arms[1][1], sine * arms[1][0] + cosine * arms[1][1]])
        model.set_variable("turned1", moved.T.ravel())
        # Whole Newton steps: its line search stalls where nodes open and close.
        whole = "lsearch", "simplest", "alpha min", 1.0, "alpha max ratio", 1e9
        if not model.solve("max_res", 1e-7, "max_iter", 30, "lsolver", "mumps", *whole)[1]:
            raise RuntimeError(f"GetFEM's Newton iterations do not converge with the wheel turned by {angle} rad")
        torques = []
        for number in range(2):
            forces = np.zeros(bodies[number][1].nbdof())
            forces[hubs[number]] = stiffness[number].mult(model.variable(f"u{number}"))[hubs[number]]
            torques.append(float(arms[number][0] @ forces[1::2] - arms[number][1] @ forces[::2]))
        return torques

    return turn, sum(space.nbdof() for _, space, _ in bodies)


def rotation_under(turn, torque, guess):
    """The wheel's rotation under a torque, by secant steps, the last torques, and how many solutions that took."""
    angles, torques = [0.0, guess], [0.0]
    for count in range(1, 12):
        both = turn(angles[-1])
        torques.append(both[1])
        if abs(torques[-1] / torque - 1.0) < CLOSE_ENOUGH:
            return angles[-1], both, count
        slope = (torques[-1] - torques[-2]) / (angles[-1] - angles[-2])
        angles.append(angles[-1] + (torque - torques[-1]) / slope)
    raise RuntimeError(f"no rotation found for {torque} N: {angles}, {torques}")


def main():
    given = json.load(sys.stdin)
    gf.util_trace_level(0)
    answers = []
    for position in given["positions"]:
        begun = time.perf_counter()
        turn, unknowns = pair(given, position)
        built = time.perf_counter()
        angle, both, solutions = rotation_under(turn, given["torque"], position["guess"])
        answers.append({
            "rotation": angle, "torque_ratio": both[0] / both[1], "solutions": solutions, "unknowns": unknowns,
            "building": built - begun, "solving": time.perf_counter() - built,
        })  # fmt: skip
    json.dump({"answers": answers}, sys.stdout)


if __name__ == "__main__":
    main()
