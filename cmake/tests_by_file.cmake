# Modules whose tests' helpers share names: they are compiled a file at a time.
set(SMHT_TESTS_BY_FILE app graph mapping perception place)
