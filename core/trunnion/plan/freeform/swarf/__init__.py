"""Drive geometry of swarf milling: lines round walls at a height, and the rulings along which a cutter's flank lies on the faces there."""
