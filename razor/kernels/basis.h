// Directions about a normal.
#pragma once

#include "razor/kernels/vec.h"

namespace razor::ISA_TARGET {

/// Two unit vectors that make a right-handed system with a third: x, y, n.
struct Basis {
    vvec x, y;
};
/// Branch-free (Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017).
inline Basis basis_about(const vvec& n) {
    vint sign_bit = as_int(n.z) & vint(std::int32_t(0x80000000U));
    vfloat sign = as_float(sign_bit | as_int(vfloat(1.0F)));
    vfloat a = vfloat(-1.0F) / (sign + n.z);
    vfloat b = n.x * n.y * a;
    vfloat sx = sign * n.x;
    Basis basis;
    basis.x.x = fma(sx, n.x * a, vfloat(1.0F));
    basis.x.y = sign * b;
    basis.x.z = -sx;
    basis.y.x = b;
    vfloat ya = n.y * a;
    basis.y.y = fma(n.y, ya, sign);
    basis.y.z = -n.y;
    return basis;
}
/// (x, y, z) where `n` is the z axis.
inline vvec to_world(const vvec& n, const vfloat& x, const vfloat& y, const vfloat& z) {
    Basis basis = basis_about(n);
    vvec w = madd(y, basis.y, basis.x * x);
    return madd(z, n, w);
}

} // namespace razor::ISA_TARGET
