"""Values of a peer, and what wrote them."""
