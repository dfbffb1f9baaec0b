#pragma once
#include <cstdint>
#include <functional>

#include "softgrain/rigid/contacts.hpp"
#include "softgrain/state/field.hpp"

namespace softgrain {

/// Declares the impulses of contacts that carry one, with their bodies: the order of a list depends on the
/// friction of its contacts, which a run that goes on may change. Of those read, this rank has those for
/// which is_mine(body_a, body_b). Raises IoError for contacts that the list does not have.
template <int Dim>
void visit_impulses(RigidContacts<Dim>& contacts, StateVisitor& visit,
                    const std::function<bool(std::int64_t, std::int64_t)>& is_mine);

}  // namespace softgrain
