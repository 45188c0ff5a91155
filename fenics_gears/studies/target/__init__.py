"""`[accuracy] target`: settings chosen by measurement, the cheapest whose errors together stay below a target."""
