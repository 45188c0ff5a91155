"""FZG gears beside GEARpie (github.com/cfernandesFEUP/GEARpie, REPORT/C14.txt), whose losses are fitted to rigs."""

from tests.coarse import COARSE
from tests.evidence.claim import PROGRAMS, Claim, Numbers, Part, within
from tests.extensions.rating.test_iso_6336 import FZG_C, operation

from fenics_gears import Load, simulate
from fenics_gears.effects.friction import Friction
from fenics_gears.extensions.rating.root import form_at_outer_point
from fenics_gears.scene.data import Motion, Scene

# 200 N m on the pinion at 1500 1/min; its mean coefficient of friction by Schlenk and what follows.
COEFFICIENT, LOSS, LOSS_FACTOR, POWER, SPEED = 0.0483, 295.17, 0.1945, 31415.9, 1500.0


def numbers(_: str) -> Numbers:
    gears = FZG_C[0]
    teeth = gears.pinion.teeth
    scene = Scene("FZG C14", gears, Load(300e3), Motion(SPEED * teeth / 60.0, 2, 2), COARSE,
                  friction=Friction(COEFFICIENT))  # fmt: skip
    loss = simulate(scene).attrs["friction_loss"]
    found = operation(gears, 200e3, SPEED)
    tooth = form_at_outer_point(found.pair.pinion, found.pair.contact_ratio)
    return {
        "loss": (LOSS, loss * POWER),
        "factor": (LOSS_FACTOR, loss / COEFFICIENT),
        "form": (FZG_C[1]["Y_F"][0], tooth.form),
        "correction": (FZG_C[1]["Y_S"][0], tooth.stress_correction),
    }


WHOSE = "GEARpie, report of the FZG gear C14"
PART = Part(
    "gearpie", PROGRAMS, "experiments.md#losses",
    {
        "loss": Claim("mesh loss at 200 N m and 1500 1/min, coefficient by Schlenk", WHOSE, "W", within(0.05),
                      "elastic teeth share the load more smoothly than the rigid ones there"),
        "factor": Claim("gear loss factor, Wimmer", WHOSE, "", within(0.05), "the same"),
        "form": Claim("form factor Y_F, DIN 3990", WHOSE, "", within(7e-4), "printed digits"),
        "correction": Claim("stress correction factor Y_S", WHOSE, "", within(7e-4), "printed digits"),
    },
    numbers,
)  # fmt: skip
