"""What the effects of a scene cost and what they change: the scene run with subsets of its effects, in one process (`gears effects`)."""
