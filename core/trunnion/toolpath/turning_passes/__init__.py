"""What turning strategies share: paths in the making, passes along a contour, the stock that they leave."""
