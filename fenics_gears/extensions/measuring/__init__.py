"""What accuracy and effects cost in time: ``gears accuracy``, ``gears effects``, ``gears report --effects``."""
