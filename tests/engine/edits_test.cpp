#include "engine/tree.h"

#include <catch2/catch.hpp>
