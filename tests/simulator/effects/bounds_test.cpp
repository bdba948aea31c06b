// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/bounds.h"

#include <gtest/gtest.h>
