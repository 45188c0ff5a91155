"""`[accuracy] target`: the cheapest settings that reach it, chosen by trial runs whose errors are measured and by costs that are counted."""
