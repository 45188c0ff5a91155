"""``[profile_modifications]``: crowning and slope of the profile of either gear (``geometry.profile_modification``)."""

from fenics_gears.geometry.profile_modification import ProfileModifications, profile_curves

from .effect import Effect


def removal(modifications: ProfileModifications, pair):
    return profile_curves(pair, modifications)


EFFECT = Effect(
    section="profile_modifications",
    description="crowning and slope of the profiles",
    absent="profiles without crowning and slope",
    fields=ProfileModifications,
    terms=("gaps between the flanks",),
    removal=removal,
)
