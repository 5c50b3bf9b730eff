"""Looking for better walls than one pass gives: ruin and recreate, courses planned and laid."""
