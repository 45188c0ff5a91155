"""What accuracy costs in time: each setting's error with the others fine, whole settings, cheaper models beside them; and the orders and limits that targets are chosen by, too."""
