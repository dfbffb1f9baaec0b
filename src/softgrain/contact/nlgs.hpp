#pragma once
#include <span>

#include "softgrain/contact/contact_system.hpp"
#include "softgrain/contact/signorini_coulomb.hpp"
