"""The version of the program's numbers: what is kept on disk under another one is computed anew."""

# To be raised by one with any change after which the same scene or the same gear gives other numbers, or other arrays
# in the cache. Condensed gears, cases of studies and maps, and runs of optimisations are kept under it;
# tests/test_numbers_version.py notices most changes.
NUMBERS_VERSION = 33
