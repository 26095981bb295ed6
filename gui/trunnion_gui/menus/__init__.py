"""What a person can do from menus, toolbar, keys and the finder: the commands by subject, and the bars that show them."""
