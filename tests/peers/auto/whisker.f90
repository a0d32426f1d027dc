! A whisker against a pole, as the forward boundary-value problem of Hires, Pammer, Svoboda and Golomb (2013),
! eLife 2:e01350, Eqs 8-13, for AUTO-07p. Lengths in whisker lengths L_w, forces in E I_base / L_w^2.
!
! The laboratory's frame: base at the origin with tangent angle theta_0, pole's centre at (D, 0). Arclength is scaled
! by the unknown contact arclength, so that the whisker from base to contact is the unit interval. The force F is
! normal to the whisker at the contact, the moment vanishes there, and the pole touches tangentially.
!
!   U(1) x, U(2) y, U(3) theta     position and tangent angle, in the laboratory's frame
!   U(4) t                         slope of the resting parabola y = A (x - vertex)^2
!   U(5) rho                       radius, relative to the base's
!
!   PAR(1) theta_0     angle of the base, the continuation parameter
!   PAR(2) F           force, + on the convex side (CB), - on the concave side (CF)
!   PAR(3) s_obj       arclength of the contact
!   PAR(4) psi         tangent angle at the contact, from the base's tangent
!   PAR(5) D           distance of the pole's centre
!   PAR(6) A           PAR(7) t at the base      PAR(8) taper 1 - r_tip/r_base
!   PAR(9) r_pole, with the sign of F
!   PAR(10) q = F s_obj^2/rho^2 at the contact, computed from the others

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  implicit none
  integer, intent(in) :: ndim, icp(*), ijac
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision :: c, s, root, stiffness, lever, bend, cc, sc, force, length, a

  force = par(2); length = par(3); a = par(6)
  c = cos(u(3)); s = sin(u(3))
  cc = cos(par(1) + par(4)); sc = sin(par(1) + par(4))
  root = sqrt(1 + u(4)**2)
  stiffness = u(5)**4
  ! Seen along the contact's tangent, the pole's centre is as far away as the contact: its radius drops out.
  lever = (par(5) - u(1))*cc - u(2)*sc
  bend = 2*a/root**3 + force*lever/stiffness

  f = length*[c, s, bend, 2*a/root, -par(8)]
  if (ijac == 0) return

  dfdu = 0
  dfdu(1, 3) = -length*s
  dfdu(2, 3) = length*c
  dfdu(3, 1) = -length*force*cc/stiffness
  dfdu(3, 2) = -length*force*sc/stiffness
  dfdu(3, 4) = -length*6*a*u(4)/root**5
  dfdu(3, 5) = -length*4*force*lever/u(5)**5
  dfdu(4, 4) = -length*2*a*u(4)/root**3
  if (ijac == 1) return

  ! Only PAR(1) to PAR(5) are ever free.
  dfdp(:, 1:5) = 0
  dfdp(3, 1) = -length*force*((par(5) - u(1))*sc + u(2)*cc)/stiffness
  dfdp(3, 2) = length*lever/stiffness
  dfdp(:, 3) = f/length
  dfdp(3, 4) = dfdp(3, 1)
  dfdp(3, 5) = length*force*cc/stiffness
end subroutine func

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
  implicit none
  integer, intent(in) :: ndim, icp(*), nbc, ijac
  double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
  double precision, intent(out) :: fb(nbc)
  double precision, intent(inout) :: dbc(nbc, *)
  double precision :: cc, sc
  integer :: i

  cc = cos(par(1) + par(4)); sc = sin(par(1) + par(4))
  fb(1:5) = u0 - [0d0, 0d0, par(1), par(7), 1d0]
  ! The contact is off the pole's centre by its radius, along the normal: above it for CB, below it for CF.
  fb(6) = u1(1) - par(5) + par(9)*sc
  fb(7) = u1(2) - par(9)*cc
  fb(8) = u1(3) - par(1) - par(4)
  if (ijac == 0) return

  ! Columns: U at the base, U at the contact, PAR.
  dbc(:, 1:2*ndim + 9) = 0
  do i = 1, 5
    dbc(i, i) = 1
  end do
  do i = 1, 3
    dbc(5 + i, ndim + i) = 1
  end do
  if (ijac == 1) return
  dbc(3, 2*ndim + 1) = -1
  dbc(6, 2*ndim + 1) = par(9)*cc
  dbc(7, 2*ndim + 1) = par(9)*sc
  dbc(8, 2*ndim + 1) = -1
  dbc(6:8, 2*ndim + 4) = dbc(6:8, 2*ndim + 1)
  dbc(6, 2*ndim + 5) = -1
end subroutine bcnd

! The resting whisker, where every branch starts, comes as data from compare.py.
subroutine stpnt
end subroutine stpnt

subroutine icnd
end subroutine icnd

subroutine fopt
end subroutine fopt

! A coordinate that grows along a whole branch, through its folds, where no other does: the load at the contact.
subroutine pvls(ndim, u, par)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim, *)
  double precision, intent(inout) :: par(*)

  par(10) = par(2)*(par(3)/(1 - par(8)*par(3)))**2
end subroutine pvls
