"""``gears optimize``: modifications of a pair chosen by its results over loads and tolerances."""
