"""`[accuracy] target`: choose the cheapest settings that reach it, from errors measured by trial runs and from counted
costs."""
