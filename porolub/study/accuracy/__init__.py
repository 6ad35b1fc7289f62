"""What accuracy costs: settings of a scene as a sweep, their errors, advice."""
