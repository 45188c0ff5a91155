"""What accuracy costs in time: each knob's error with the others fine, cheaper models beside them, and whole settings that pay."""
