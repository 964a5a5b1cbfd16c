! Grains as a UMAT and a UEXTERNALDB of Abaqus/Standard, plane strain, one RVE for each integration point.
!
! A host calls UMAT for one point and wants the answer at once; a batch is fast only if it has all points. Two ways:
!   one_rve_a_batch = .true.    Each point has a batch of its own. The answer is exact; RVEs run one at a time.
!   one_rve_a_batch = .false.   One batch has all points. Within an increment UMAT answers by the committed stress and
!                               tangent and keeps the deformation; UEXTERNALDB evaluates all points at the end of the
!                               increment and commits. The host's next increment begins with the stress of the grains,
!                               so that it carries what is out of balance. This is a scheme without iteration:
!                               increments must be small, and `largest_error` says how far the answers were off.
! The grains have no stress out of the plane; STRESS(3) is 0.
module grains_umat
  use voussoir
  implicit none
  logical :: one_rve_a_batch = .false.
  integer :: points = 0, points_per_element = 1
  character(len=4096) :: case_file = '', settings = ''
  real(c_double) :: largest_error = 0     ! of the answers by tangents, over the mean stress, of all increments [-]
  type(c_ptr), allocatable :: batches(:)  ! one, or one for each point
  real(c_double), allocatable :: gradient(:, :, :), stress_now(:, :)
  real(c_double), allocatable, target :: tangent_now(:, :, :)

contains

  subroutine require(code)
    integer(c_int), intent(in) :: code
    if (code == voussoir_ok) return
    write (*, '(a)') voussoir_error_text()
    error stop 1  ! a UMAT calls XIT here
  end subroutine

  subroutine open_grains()
    integer :: b, n
    n = merge(1, points, one_rve_a_batch)
    allocate (batches(points / n), gradient(2, 2, points), stress_now(3, points), tangent_now(3, 3, points))
    gradient = 0
    call require(voussoir_start(0))
    do b = 1, size(batches)
      call require(voussoir_create(trim(case_file) // c_null_char, int(n, c_int64_t), trim(settings) // c_null_char, &
                                   c_null_funptr, c_null_ptr, batches(b)))
      call require(voussoir_committed(batches(b), int(n, c_int64_t), stress_now(:, b:), c_loc(tangent_now(1, 1, b))))
    end do
  end subroutine

  subroutine close_grains()
    integer :: b
    do b = 1, size(batches)
      call require(voussoir_destroy(batches(b)))
    end do
    deallocate (batches, gradient, stress_now, tangent_now)
  end subroutine

  subroutine begin_increment()
    integer :: b
    gradient = 0
    do b = 1, size(batches)
      call require(voussoir_begin_increment(batches(b)))
    end do
  end subroutine

  ! All points at once; the points that have a batch each were evaluated by UMAT.
  subroutine end_increment()
    real(c_double) :: foretold(3, points)
    integer :: b, k
    if (.not. one_rve_a_batch) then
      do k = 1, points
        foretold(:, k) = linear_stress(k)
      end do
      call require(voussoir_evaluate(batches(1), int(points, c_int64_t), gradient, stress_now, c_loc(tangent_now), &
                                     c_null_ptr))
      do k = 1, points
        largest_error = max(largest_error, norm2(stress_now(:, k) - foretold(:, k)) / &
                            (0.5 * abs(stress_now(1, k) + stress_now(2, k))))
      end do
    end if
    do b = 1, size(batches)
      call require(voussoir_commit(batches(b)))
    end do
  end subroutine

  ! sigma + D e + W sigma - sigma W of the committed sigma and D, where e and W are the symmetric and the skew part of
  ! the gradient since the last commit.
  function linear_stress(k) result(s)
    integer, intent(in) :: k
    real(c_double) :: s(3), e(3), w
    s = stress_now(:, k)
    w = 0.5 * (gradient(2, 1, k) - gradient(1, 2, k))
    e = [gradient(1, 1, k), gradient(2, 2, k), gradient(1, 2, k) + gradient(2, 1, k)]
    s = s + matmul(tangent_now(:, :, k), e) + w * [2 * s(3), -2 * s(3), s(2) - s(1)]
  end function

  ! Stress and tangent of one point. A point without an answer is told to the host, which cuts the increment.
  subroutine answer(k, s, d, has_answer)
    integer, intent(in) :: k
    real(c_double), intent(out) :: s(3), d(3, 3)
    logical, intent(out) :: has_answer
    real(c_double) :: found(3, 1)
    real(c_double), target :: found_tangent(3, 3, 1)
    integer(c_int) :: code
    has_answer = .true.
    s = linear_stress(k)
    d = tangent_now(:, :, k)
    if (.not. one_rve_a_batch) return
    code = voussoir_evaluate(batches(k), 1_c_int64_t, gradient(:, :, k:k), found, c_loc(found_tangent), c_null_ptr)
    has_answer = code == voussoir_ok
    if (code == voussoir_no_equilibrium) return
    call require(code)
    s = found(:, 1)
    d = found_tangent(:, :, 1)
  end subroutine
end module grains_umat

! LOP: 0 the analysis begins, 1 an increment begins (perhaps anew after a cut), 2 it ends, 3 the analysis ends.
subroutine uexternaldb(lop, lrestart, time, dtime, kstep, kinc)
  use grains_umat
  implicit none
  integer :: lop, lrestart, kstep, kinc
  real(c_double) :: time(2), dtime
  select case (lop)
  case (0); call open_grains()
  case (1); call begin_increment()
  case (2); call end_increment()
  case (3); call close_grains()
  end select
end subroutine

subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
                dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, &
                dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
  use grains_umat
  implicit none
  character(len=80) :: cmname
  integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
  real(c_double) :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, ddsddt(ntens), &
    drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1), &
    props(nprops), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3)
  integer, parameter :: of(3) = [1, 2, 4]  ! xx, yy, xy among the components of plane strain
  real(c_double) :: f(2, 2), inverse(2, 2), s(3), d(3, 3)
  integer :: k
  logical :: has_answer
  k = (noel - 1) * points_per_element + npt
  inverse = reshape([dfgrd0(2, 2), -dfgrd0(2, 1), -dfgrd0(1, 2), dfgrd0(1, 1)], [2, 2]) &
            / (dfgrd0(1, 1) * dfgrd0(2, 2) - dfgrd0(1, 2) * dfgrd0(2, 1))
  f = matmul(dfgrd1(1:2, 1:2), inverse)
  gradient(:, :, k) = transpose(f)
  gradient(1, 1, k) = gradient(1, 1, k) - 1
  gradient(2, 2, k) = gradient(2, 2, k) - 1
  call answer(k, s, d, has_answer)
  if (.not. has_answer) pnewdt = 0.5
  stress = 0
  ddsdde = 0
  stress(of) = s
  ddsdde(of, of) = d
end subroutine
