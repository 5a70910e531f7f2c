#pragma once

#include "systems/contact/support/footing.hpp"

namespace torsion {

/// response = fit times the ports' compliance times the fit transposed: the terms of the polynomial
/// in which a footing moves by unit moments.
void find_response(const PortCompliance& body, const Footing& footing, FootingResponse& response);

}  // namespace torsion
