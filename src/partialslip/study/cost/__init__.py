"""The study of cost: CPU seconds against accuracy, and the price list fitted to them."""
