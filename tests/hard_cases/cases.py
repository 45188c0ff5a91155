"""The hard cases: number, name and what must hold. Each has a file `test_row_NN_*.py` beside this one."""

CASES = {
    1: (
        "random loads, gaps and initial guesses",
        "Signorini's conditions: p_n >= 0, gap >= -1e-4 um, p_n gap = 0 to 1e-10",
    ),
    2: ("Coulomb friction", "abs(p_t) <= mu p_n, p_t opposes slip, the friction loss is never negative"),
    3: (
        "action and reaction",
        (
            "forces and moments on the two gears sum to zero to 1e-12; without friction the torques are in the ratio of"
            " the base radii, T1/rb1 = T2/rb2"
        ),
    ),
    4: (
        "energy balance",
        (
            "the balance of a step closes to 1e-11 of the work at a fixed mesh position; energy stays bounded over 400"
            " flights of an undamped bounce"
        ),
    ),
    5: (
        "condensed stiffness S (Schur complement)",
        "the 3 rigid motions R cause no force to 1e-10, S is symmetric, and no other eigenvalue is zero",
    ),
    6: ("condensed and uncondensed stiffness; ring of sectors and whole gear", "both agree to 1e-9"),
    7: (
        "contact patch test: uniform pressure",
        "exact to 1e-10 with matching meshes and with averaged interpolation; the error of collocation is recorded",
    ),
    8: (
        "Hertz line contact with 2, 4 and 8 elements of size h in the half-width b",
        "peak pressure within 4, 1 and 0.5 %; half-width of order 1 or more",
    ),
    9: ("other start angle; mirrored pair; swapped gears", "same transmission error to 1e-10"),
    10: (
        "friction coefficients from 1e-2 to 1e-12",
        "the difference from mu = 0 is proportional to mu; without friction there are no tangential unknowns",
    ),
    11: (
        "projection parameter r scaled by 1e-6 to 1e6",
        "same solution to 1e-9, by Newton's method or by a fallback that is named",
    ),
    12: ("order of nodes and gears", "no influence to 1e-11"),
    13: ("unit systems", "same dimensionless result to 1e-9, same number of iterations"),
    14: ("Poisson's ratio 0.499", "second-order elements are accurate; a warning names elements that lock"),
    15: (
        "shaft and bearing stiffness from 1e-3 to 1e12 of nominal",
        "monotone convergence to rigid shafts and bearings",
    ),
    16: ("load torque 0, 1e-12 N mm, 1 N mm and 10 times nominal", "no spurious force, no NaN, no failed step"),
    17: (
        "torque reversal, undamped resonance, sudden release",
        "teeth separate, fly freely, cross the backlash, touch on the coast flanks and return; the result reports it",
    ),
    18: (
        "all gaps open",
        "free flight is exact; a quasi-static run ends with an error that names the load and the free motion",
    ),
    19: (
        "one contact node; coincident nodes; nodes closer than elements",
        "one node is exact; coincident nodes share the force equally; dependent nodes cause a warning",
    ),
    20: (
        "friction coefficients 0.3, 0.6, 1 and 2",
        "the run converges, or names self-locking or possibly several solutions",
    ),
    21: (
        "a step on the pitch point and 1e-12 mm beside it",
        "friction changes its sign through sticking, no failed step",
    ),
    22: (
        "teeth that enter and leave; sharp tips",
        "the transmission error is continuous as time step and mesh are refined; a warning names sharp edges",
    ),
    23: (
        "mesh frequencies from 0.01 Hz to 20 kHz",
        (
            "0.01 Hz agrees with the quasi-static result to 1e-6; at 20 kHz the gears follow the mean motion; no"
            " vibration is left from the start"
        ),
    ),
    24: ("time step up to 1000 times too long", "energy stays bounded; a warning names the highest resolved frequency"),
    25: (
        "order of the time stepping",
        "order 2 while the contact status is unchanged and through stick, about 2 where nodes open and close",
    ),
    26: (
        "wrong values in every field of a scene",
        (
            "refused before any computation, with file, field, value, what is allowed and nearest name; exit code 2;"
            " nothing is written"
        ),
    ),
    27: (
        "damaged cache entry, full disk, kill -9, two runs on one cache",
        "computed again or continued; never a wrong number or half a result under a valid name",
    ),
    28: (
        "one rank of an MPI study fails",
        "its case is recorded as failed with the reason, the others finish, nothing hangs, exit code 3",
    ),
}
