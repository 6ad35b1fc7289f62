"""What a sweep asks for: its file, axes, cases and their neighbours."""
