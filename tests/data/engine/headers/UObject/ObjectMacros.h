// Stand-in for tests: what the header tool reads, and the compiler does not. Not engine code.
#pragma once

#include "CoreMinimal.h"

#define UENUM(...)
#define UMETA(...)
#define UCLASS(...)
#define USTRUCT(...)
#define UPROPERTY(...)

class FObjectInitializer
{
};
