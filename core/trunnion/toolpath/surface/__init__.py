"""Surface machining: scallops and stepovers, and the strategies that sweep cutters over free-form faces."""
