"""How the cases of a sweep are computed: queue, one case, journal, table, progress."""
